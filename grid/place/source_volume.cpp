#include "grid/place/source_volume.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>

#include <fmt/ranges.h>

#include "level2/decode/problem_notes.h"
#include "level2/decode/volume_checks.h"
#include "stormcellar/base/station_table.h"

namespace stormcellar::grid {
namespace {

bool holds_any(const level2::Volume& volume, const std::vector<level2::Moment>& moments) {
    return std::ranges::any_of(moments, [&](level2::Moment moment) {
        return level2::holds(volume, level2::measured_moment(moment));
    });
}

// Decodes the metadata, lets `choose_cuts` choose cuts, and decodes these cuts. Returns none if
// decoding fails, there is no pattern, all cuts are chosen, the cuts do not hold the moments, or
// the file has several volumes.
std::optional<level2::Decoded> decode_cuts(std::span<const std::byte> bytes,
                                           level2::DecodeOptions options,
                                           const ChooseCuts& choose_cuts) {
    constexpr int no_cut = 10'000;
    options.selection.elevation_numbers = {no_cut};
    const auto metadata = level2::decode(bytes, options);
    if (!metadata || !metadata->volume.vcp_message) return std::nullopt;
    options.selection.elevation_numbers = choose_cuts(metadata->volume);
    if (options.selection.all_cuts()) return std::nullopt;
    auto decoded = level2::decode(bytes, options);
    if (!decoded) return std::nullopt;
    const std::vector<level2::Moment>& wanted = options.selection.moments;
    if (!wanted.empty() && !holds_any(decoded->volume, wanted)) return std::nullopt;
    // The other volumes of the file may have other patterns.
    if (!decoded->report.further_volume_starts.empty()) return std::nullopt;
    return std::move(*decoded);
}

// Takes one volume of the file. If the file has several volumes, adds a note that names the volume
// taken.
Result<level2::Volume> take_volume(level2::Decoded decoded, const SourceWish& wish,
                                   SourceVolume& source) {
    const bool damaged = decoded.report.damaged;
    std::vector<level2::Volume> volumes = level2::split_volumes(std::move(decoded));
    const bool by_start = wish.start && volumes.size() > 1;
    const auto found = std::ranges::find_if(volumes, [&](const auto& volume) {
        return by_start ? volume.start_time() == wish.start : holds_any(volume, wish.moments);
    });
    if (by_start && found == volumes.end()) {
        return fail(ErrorCode::not_found, "holds no volume that starts at {}",
                    format_utc(*wish.start));
    }
    std::size_t index =
        found == volumes.end() ? 0 : static_cast<std::size_t>(found - volumes.begin());
    if (wish.volume > 0) index = static_cast<std::size_t>(wish.volume) - 1;
    if (index >= volumes.size()) {
        return fail(ErrorCode::bad_argument, "holds only {} {}; --volume {} asks for another",
                    volumes.size(), volumes.size() == 1 ? "volume" : "volumes", wish.volume);
    }
    if (volumes.size() > 1) {
        source.partial = damaged || !level2::is_complete(volumes[index]);
        source.notes.push_back(
            fmt::format("the file holds {} volumes; this is number {}", volumes.size(), index + 1));
    }
    return std::move(volumes[index]);
}

}  // namespace

level2::DecodeOptions decode_options_of(const SourceWish& wish, const std::string& file_name) {
    level2::DecodeOptions options;
    options.threads = wish.threads;
    if (!wish.needs_all_moments) options.selection.moments = wish.moments;
    options.fallback_station = station_in_name(file_name);
    return options;
}

Result<level2::Decoded> decode_wished(std::span<const std::byte> bytes, const std::string& file,
                                      const level2::DecodeOptions& options,
                                      const ChooseCuts& choose_cuts) {
    if (choose_cuts) {
        auto few = decode_cuts(bytes, options, choose_cuts);
        if (few) return std::move(*few);
    }
    auto decoded = level2::decode(bytes, options);
    if (!decoded) return fail(decoded.error().code, "{}: {}", file, decoded.error().message);
    return decoded;
}

Result<SourceVolume> take_source(level2::Decoded decoded, const std::string& file,
                                 const SourceWish& wish) {
    SourceVolume source;
    source.partial = !decoded.report.complete;
    std::vector<std::string> troubles;
    if (decoded.report.rda_status) troubles = level2::rda_troubles(*decoded.report.rda_status);
    source.notes = level2::notes_of(decoded.report);
    auto volume = take_volume(std::move(decoded), wish, source);
    if (!volume) return fail(volume.error().code, "{}: {}", file, volume.error().message);
    source.volume = std::move(*volume);
    if (wish.place) {
        if (Status placed = wish.place(source.volume); !placed)
            return fail(placed.error().code, "{}: {}", file, placed.error().message);
    }
    if (wish.derive) {
        const auto notes = wish.derive(source.volume);
        if (!notes) return fail(notes.error().code, "{}: {}", file, notes.error().message);
        source.notes.insert(source.notes.end(), notes->begin(), notes->end());
    }
    if (!troubles.empty()) {
        source.radar_troubles = {
            fmt::format("{}: {}", source.volume.station, fmt::join(troubles, ", "))};
    }
    const auto antenna = level2::antenna_position(source.volume);
    if (!antenna) {
        return fail(ErrorCode::not_found,
                    "{}: neither the file nor the station table gives the position of the radar{}",
                    file, wish.how_to_place);
    }
    if (antenna->disagreement) source.notes.push_back(*antenna->disagreement);
    source.site = {source.volume.station, antenna->latitude_deg, antenna->longitude_deg,
                   antenna->altitude_m};
    return source;
}

Result<SourceVolume> decode_source(std::span<const std::byte> bytes, const std::string& file,
                                   const SourceWish& wish) {
    const std::string name = std::filesystem::path{file}.filename().string();
    auto decoded = decode_wished(bytes, file, decode_options_of(wish, name), wish.choose_cuts);
    if (!decoded) return pass_on(decoded);
    return take_source(std::move(*decoded), file, wish);
}

}  // namespace stormcellar::grid
