#include "cli/volume_source.h"

#include <algorithm>

#include "base/file_system.h"
#include "base/station_table.h"
#include "cli/problem_notes.h"
#include "cli/stopwatch.h"
#include "level2/chunk_directory.h"
#include "level2/decode.h"

namespace stormcellar::cli {
namespace {

bool holds(const level2::Volume& volume, level2::Moment moment) {
    return std::any_of(volume.sweeps.begin(), volume.sweeps.end(),
                       [&](const level2::Sweep& sweep) { return sweep.find(moment) != nullptr; });
}

Result<level2::Decoded> read_and_decode(const std::filesystem::path& path, int threads,
                                        level2::Moment moment, SourceVolume& source) {
    Stopwatch watch;
    level2::DecodeOptions options;
    options.threads = threads;
    options.selection.moments = {moment};
    const std::string name = path.filename().string().substr(0, 4);
    if (find_station(name)) options.fallback_station = name;
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored)) {
        auto joined = level2::decode_path(path, options);
        source.decode_s = watch.lap_s();
        return joined;
    }
    const auto bytes = read_file(path);
    source.read_s = watch.lap_s();
    if (!bytes) return pass_on(bytes);
    auto decoded = level2::decode(*bytes, options);
    source.decode_s = watch.lap_s();
    if (!decoded) {
        return fail(decoded.error().code, "{}: {}", path.string(), decoded.error().message);
    }
    return decoded;
}

// The first volume of a file that holds the moment; of a file with several, a note says so.
level2::Volume take_volume(level2::Decoded decoded, level2::Moment moment,
                           std::vector<std::string>& notes) {
    std::vector<level2::Volume> volumes = level2::split_volumes(std::move(decoded));
    const auto found = std::find_if(volumes.begin(), volumes.end(),
                                    [&](const auto& volume) { return holds(volume, moment); });
    const std::size_t index =
        found == volumes.end() ? 0 : static_cast<std::size_t>(found - volumes.begin());
    if (volumes.size() > 1) {
        notes.push_back(
            fmt::format("the file holds {} volumes; this is number {}", volumes.size(), index + 1));
    }
    return std::move(volumes[index]);
}

}  // namespace

Result<SourceVolume> load_volume(const std::filesystem::path& path, level2::Moment moment,
                                 int threads) {
    SourceVolume source;
    auto decoded = read_and_decode(path, threads, moment, source);
    if (!decoded) return pass_on(decoded);
    source.partial = !decoded->report.complete;
    source.notes = notes_of(decoded->report);
    source.volume = take_volume(std::move(*decoded), moment, source.notes);
    const auto antenna = level2::antenna_position(source.volume);
    if (!antenna) {
        // A station that the file does name is not overruled by the name of the file.
        const bool nameless = source.volume.station.empty();
        return fail(ErrorCode::not_found,
                    "{}: neither the file nor the station table says where the radar stands{}",
                    path.string(),
                    nameless ? "; a file name that begins with the radar's four letters, as in "
                               "KTLX20240601_220000, would say it"
                             : "");
    }
    if (antenna->disagreement) source.notes.push_back(*antenna->disagreement);
    source.site = {source.volume.station, antenna->latitude_deg, antenna->longitude_deg,
                   antenna->altitude_m};
    return source;
}

}  // namespace stormcellar::cli
