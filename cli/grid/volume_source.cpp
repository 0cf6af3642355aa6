#include "cli/grid/volume_source.h"

#include <algorithm>
#include <optional>
#include <span>

#include <fmt/ranges.h>

#include "base/steady_time.h"
#include "cli/shared/problem_notes.h"
#include "level2/decode/volume_checks.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/level2/chunk_directory.h"
#include "stormcellar/level2/decode.h"

namespace stormcellar::cli {
namespace {

bool holds_any(const level2::Volume& volume, const std::vector<level2::Moment>& moments) {
    return std::ranges::any_of(
        moments, [&](level2::Moment moment) { return level2::holds(volume, moment); });
}

// Decodes the metadata, so that the pattern says which cuts are needed. Returns none if it does
// not.
std::optional<level2::Decoded> decode_cuts(std::span<const std::byte> bytes,
                                           level2::DecodeOptions options,
                                           const std::vector<level2::Moment>& moments,
                                           const ChooseCuts& choose_cuts) {
    constexpr int no_cut = 10'000;
    options.selection.elevation_numbers = {no_cut};
    const auto metadata = level2::decode(bytes, options);
    if (!metadata || !metadata->volume.vcp_message) return std::nullopt;
    options.selection.elevation_numbers = choose_cuts(metadata->volume);
    if (options.selection.all_cuts()) return std::nullopt;
    auto decoded = level2::decode(bytes, options);
    if (!decoded || !holds_any(decoded->volume, moments)) return std::nullopt;
    return std::move(*decoded);
}

level2::DecodeOptions options_of(const GridRequest& request, const std::string& file_name) {
    level2::DecodeOptions options;
    options.threads = request.threads;
    options.selection.moments = request.moments();
    options.fallback_station = station_in_name(file_name);
    return options;
}

Result<level2::Decoded> decode_bytes(std::span<const std::byte> bytes, const std::string& file,
                                     const level2::DecodeOptions& options,
                                     const GridRequest& request, const ChooseCuts& choose_cuts) {
    if (choose_cuts) {
        auto few = decode_cuts(bytes, options, request.moments(), choose_cuts);
        if (few) return std::move(*few);
    }
    auto decoded = level2::decode(bytes, options);
    if (!decoded) return fail(decoded.error().code, "{}: {}", file, decoded.error().message);
    return decoded;
}

Result<level2::Decoded> read_and_decode(InputFiles& inputs, const InputFile& file,
                                        const GridRequest& request, const ChooseCuts& choose_cuts,
                                        SourceVolume& source) {
    Stopwatch watch;
    const level2::DecodeOptions options = options_of(request, file.file_name());
    std::error_code ignored;
    if (file.member.empty() && std::filesystem::is_directory(file.path, ignored)) {
        auto joined = level2::decode_path(file.path, options);
        source.decode_s = watch.lap_s();
        return joined;
    }
    const auto bytes = inputs.read(file);
    source.read_s = watch.lap_s();
    if (!bytes) return pass_on(bytes);
    auto decoded = decode_bytes(*bytes, file.label, options, request, choose_cuts);
    source.decode_s = watch.lap_s();
    return decoded;
}

// Takes the first volume of a file that holds one of the moments. If the file has several volumes,
// a note says so.
level2::Volume take_volume(level2::Decoded decoded, const std::vector<level2::Moment>& moments,
                           SourceVolume& source) {
    const bool damaged = decoded.report.damaged;
    std::vector<level2::Volume> volumes = level2::split_volumes(std::move(decoded));
    const auto found = std::find_if(volumes.begin(), volumes.end(),
                                    [&](const auto& volume) { return holds_any(volume, moments); });
    const std::size_t index =
        found == volumes.end() ? 0 : static_cast<std::size_t>(found - volumes.begin());
    if (volumes.size() > 1) {
        source.partial = damaged || !level2::is_complete(volumes[index]);
        source.notes.push_back(
            fmt::format("the file holds {} volumes; this is number {}", volumes.size(), index + 1));
    }
    return std::move(volumes[index]);
}

// Takes what a picture or a grid needs of a decoded file.
Result<SourceVolume> take_source(level2::Decoded decoded, const std::string& file,
                                 const GridRequest& request, SourceVolume source) {
    source.partial = !decoded.report.complete;
    std::vector<std::string> troubles;
    if (decoded.report.rda_status) troubles = level2::rda_troubles(*decoded.report.rda_status);
    source.notes = notes_of(decoded.report);
    source.volume = take_volume(std::move(decoded), request.moments(), source);
    if (Status applied = apply_site(request.site, source.volume); !applied) {
        return fail(applied.error().code, "{}: {}", file, applied.error().message);
    }
    if (!troubles.empty()) {
        source.radar_troubles = {
            fmt::format("{}: {}", source.volume.station, fmt::join(troubles, ", "))};
    }
    const auto antenna = level2::antenna_position(source.volume);
    if (!antenna) {
        return fail(
            ErrorCode::not_found,
            "{}: neither the file nor the station table gives the position of the radar; name the "
            "radar with --station ICAO, or give its position with --position LAT,LON,HEIGHT",
            file);
    }
    if (antenna->disagreement) source.notes.push_back(*antenna->disagreement);
    source.site = {source.volume.station, antenna->latitude_deg, antenna->longitude_deg,
                   antenna->altitude_m};
    return source;
}

}  // namespace

Result<SourceVolume> load_volume(const std::string& file, const GridRequest& request,
                                 const ChooseCuts& choose_cuts) {
    std::shared_ptr<InputFiles> inputs = request.inputs;
    if (!inputs) {
        auto found = InputFiles::find({file});
        if (!found) return pass_on(found);
        inputs = std::make_shared<InputFiles>(std::move(*found));
    }
    const auto& files = inputs->files();
    const auto named = std::ranges::find(files, file, &InputFile::label);
    if (named == files.end()) {
        return fail(ErrorCode::bad_argument, "{}: holds several files; name one of them", file);
    }
    SourceVolume source;
    auto decoded = read_and_decode(*inputs, *named, request, choose_cuts, source);
    if (!decoded) return pass_on(decoded);
    return take_source(std::move(*decoded), file, request, std::move(source));
}

Result<SourceVolume> decode_volume(std::span<const std::byte> bytes, const std::string& file,
                                   const GridRequest& request, const ChooseCuts& choose_cuts) {
    const std::string name = std::filesystem::path{file}.filename().string();
    auto decoded = decode_bytes(bytes, file, options_of(request, name), request, choose_cuts);
    if (!decoded) return pass_on(decoded);
    return take_source(std::move(*decoded), file, request, {});
}

}  // namespace stormcellar::cli
