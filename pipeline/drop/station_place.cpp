#include "pipeline/drop/station_place.h"

#include <algorithm>

#include "pipeline/drop/cataloged_volume.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/level2/decode.h"

namespace stormcellar::pipeline {
namespace {

constexpr int most_files = 4;  // how many files are read

std::optional<grid::SitePosition> place_in(const catalog::CatalogReader& catalog,
                                           const catalog::CatalogEntry& entry) {
    const auto raw = read_cataloged_volume(catalog, entry);
    if (!raw) return std::nullopt;
    level2::DecodeOptions options;
    options.fallback_station = entry.station;
    options.selection.moments = {level2::Moment::ref};
    options.selection.elevation_numbers = {1};
    const auto decoded = level2::decode(raw->bytes, options);
    if (!decoded) return std::nullopt;
    const auto antenna = level2::antenna_position(decoded->volume);
    if (!antenna) return std::nullopt;
    return grid::SitePosition{entry.station, antenna->latitude_deg, antenna->longitude_deg,
                              antenna->altitude_m};
}

}  // namespace

std::optional<grid::SitePosition> place_of_station(const catalog::CatalogReader& catalog,
                                                   const std::string& icao) {
    if (const auto station = find_station(icao)) {
        return grid::SitePosition{icao, station->latitude_deg, station->longitude_deg,
                                  station->antenna_altitude_m};
    }
    auto entries = catalog.list(icao, {});
    if (!entries) return std::nullopt;
    std::reverse(entries->begin(), entries->end());
    int tried = 0;
    for (const catalog::CatalogEntry& entry : *entries) {
        if (entry.state == catalog::FileState::gone) continue;
        if (tried++ == most_files) break;
        if (auto place = place_in(catalog, entry)) return place;
    }
    return std::nullopt;
}

}  // namespace stormcellar::pipeline
