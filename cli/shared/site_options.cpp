#include "cli/shared/site_options.h"

#include <cmath>

#include <CLI/CLI.hpp>

#include "base/number_list.h"

namespace stormcellar::cli {

void add_site_options(CLI::App& app, SiteOptions& options) {
    app.add_option("--station", options.station,
                   "ICAO identifier of the radar, such as KTLX, which overrides the FILE's own");
    app.add_option("--position", options.position,
                   "Position of the antenna: LAT,LON,HEIGHT in degrees and meters above mean sea "
                   "level. It overrides what the FILE and the station table say");
}

Result<SiteRequest> parse_site(const SiteOptions& options) {
    SiteRequest request;
    if (!options.station.empty()) {
        const auto icao = icao_of(options.station);
        if (!icao) {
            return fail(ErrorCode::bad_argument,
                        "--station takes four letters or digits, as in KTLX, not '{}'",
                        options.station);
        }
        request.station = *icao;
    }
    if (options.position.empty()) return request;
    const auto given = parse_numbers(options.position, ',');
    const bool good = given && given->size() == 3 && std::abs((*given)[0]) <= 90 &&
                      std::abs((*given)[1]) <= 180 && (*given)[2] >= -500 && (*given)[2] <= 9000;
    if (!good) {
        return fail(ErrorCode::bad_argument,
                    "--position takes LAT,LON,HEIGHT in degrees and meters above mean sea level, "
                    "as in 35.33,-97.28,390, not '{}'",
                    options.position);
    }
    request.position = SiteRequest::Position{(*given)[0], (*given)[1], (*given)[2]};
    return request;
}

Status apply_site(const SiteRequest& request, level2::Volume& volume) {
    if (!request.station.empty()) volume.station = request.station;
    if (!request.position) return {};
    if (volume.station.empty()) {
        return fail(ErrorCode::bad_argument,
                    "--position: the file names no station; give --station too");
    }
    const auto& [latitude_deg, longitude_deg, altitude_m] = *request.position;
    set_added_stations(
        {{volume.station, volume.station, latitude_deg, longitude_deg, altitude_m, true}});
    // The requested position replaces the position in the file.
    if (!volume.block) return {};
    volume.block->latitude_deg = static_cast<float>(latitude_deg);
    volume.block->longitude_deg = static_cast<float>(longitude_deg);
    volume.block->site_height_m = static_cast<std::int16_t>(std::lround(altitude_m));
    volume.block->tower_height_m = 0;
    return {};
}

}  // namespace stormcellar::cli
