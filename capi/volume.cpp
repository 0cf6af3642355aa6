#include <algorithm>
#include <filesystem>
#include <iterator>
#include <limits>
#include <memory>
#include <sstream>
#include <utility>

#include <fmt/ranges.h>

#include "capi/guarded.h"
#include "capi/volume_handle.h"
#include "level2/decode/problem_notes.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/level2/decode.h"

namespace stormcellar::capi {
namespace {

Result<level2::DecodeOptions> decode_options(const stormcellar_read_options& options) {
    if (options.threads < 0 || options.volume < 0)
        return fail(ErrorCode::bad_argument, "threads and volume must be at least 0");
    level2::DecodeOptions read;
    read.threads = std::max(1, options.threads);
    auto moments = moments_named(options.moments);
    if (!moments) return pass_on(moments);
    read.selection.moments = std::move(*moments);
    if (options.station != nullptr) read.fallback_station = options.station;
    return read;
}

// Takes the volume of this number, from 1, out of a file.
Result<std::unique_ptr<stormcellar_volume>> taken(level2::Decoded decoded, int number) {
    auto handle = std::make_unique<stormcellar_volume>();
    grid::SourceVolume& source = handle->source;
    for (const level2::Problem& problem : decoded.report.problems)
        handle->problems.push_back(problem.text());
    source.partial = !decoded.report.complete;
    source.notes = level2::notes_of(decoded.report);
    std::vector<std::string> troubles;
    if (decoded.report.rda_status) troubles = level2::rda_troubles(*decoded.report.rda_status);
    auto volumes = level2::split_volumes(std::move(decoded));
    handle->volumes_in_file = static_cast<int>(volumes.size());
    const auto index = static_cast<std::size_t>(std::max(number, 1) - 1);
    if (index >= volumes.size())
        return fail(ErrorCode::not_found, "there is no volume {}; the file has {}", index + 1,
                    volumes.size());
    source.volume = std::move(volumes[index]);
    // The report is about the whole file, so also check that this volume ended.
    source.partial = source.partial || !level2::has_ended(source.volume);
    if (!troubles.empty())
        source.radar_troubles = {
            fmt::format("{}: {}", source.volume.station, fmt::join(troubles, ", "))};
    const auto antenna = level2::antenna_position(source.volume);
    if (antenna && antenna->disagreement) source.notes.push_back(*antenna->disagreement);
    return handle;
}

// Decodes what `read` returns with the options, and gives the object to the caller.
template <class Read>
Status open_with(const stormcellar_read_options* options, stormcellar_volume** volume, Read read) {
    if (volume == nullptr) return is_null("volume");
    *volume = nullptr;
    const auto all = take(options);
    if (!all) return pass_on(all);
    const auto decoding = decode_options(*all);
    if (!decoding) return pass_on(decoding);
    Result<level2::Decoded> decoded = read(*decoding);
    if (!decoded) return pass_on(decoded);
    auto handle = taken(std::move(*decoded), all->volume);
    if (!handle) return pass_on(handle);
    *volume = handle->release();
    return {};
}

Status derive(const stormcellar_volume* volume, const char* names,
              const stormcellar_derive_options* options, stormcellar_volume** derived) {
    if (volume == nullptr || derived == nullptr)
        return is_null(volume == nullptr ? "volume" : "derived");
    *derived = nullptr;
    const auto moments = moments_named(names);
    if (!moments) return pass_on(moments);
    const auto all = take(options);
    if (!all) return pass_on(all);
    retrieve::DerivedOptions deriving;
    if (all->dealias != nullptr) {
        const auto rung = retrieve::dealiasing_from_name(all->dealias);
        if (!rung) return pass_on(rung);
        deriving.dealiasing = *rung;
    }
    if (all->storm_motion != nullptr) {
        const auto motion = retrieve::motion_choice_from(all->storm_motion);
        if (!motion) return pass_on(motion);
        deriving.motion = *motion;
    }
    if (!(all->quality >= 0 && all->quality <= 1))
        return fail(ErrorCode::bad_argument, "quality must be from 0 to 1");
    deriving.quality = all->quality;
    auto made = derived_volume(*volume, *moments, deriving);
    if (!made) return pass_on(made);
    *derived = *made ? made->release() : new stormcellar_volume(*volume);
    return {};
}

Status describe(const stormcellar_volume* volume, stormcellar_volume_facts* to) {
    if (volume == nullptr) return is_null("volume");
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    stormcellar_volume_facts facts{};
    copy_text(volume->source.volume.station, facts.station, sizeof facts.station);
    const auto antenna = level2::antenna_position(volume->source.volume);
    facts.latitude_deg = antenna ? antenna->latitude_deg : unknown;
    facts.longitude_deg = antenna ? antenna->longitude_deg : unknown;
    facts.altitude_m = antenna ? antenna->altitude_m : unknown;
    facts.start_ms = milliseconds_of(volume->source.volume.start_time());
    facts.vcp = volume->source.volume.vcp.value_or(-1);
    facts.sweeps = static_cast<std::int32_t>(volume->source.volume.sweeps.size());
    facts.complete = volume->source.partial ? 0 : 1;
    facts.volumes = volume->volumes_in_file;
    facts.problems = static_cast<std::int32_t>(volume->problems.size());
    return give(facts, to);
}

}  // namespace

Result<std::vector<level2::Moment>> moments_named(const char* names) {
    std::vector<level2::Moment> moments;
    if (names == nullptr) return moments;
    std::istringstream words{std::string{names}};
    for (std::string word; words >> word;) {
        const auto moment = level2::moment_from_name(word);
        if (!moment) {
            return fail(ErrorCode::bad_argument, "there is no moment '{}': it is {}", word,
                        level2::moment_names(", ", " or "));
        }
        moments.push_back(*moment);
    }
    return moments;
}

Result<std::unique_ptr<stormcellar_volume>> derived_volume(
    const stormcellar_volume& volume, const std::vector<level2::Moment>& moments,
    const retrieve::DerivedOptions& options) {
    if (!retrieve::must_derive(moments, options)) return std::unique_ptr<stormcellar_volume>{};
    auto derived = std::make_unique<stormcellar_volume>(volume);
    auto made = retrieve::add_derived_moments(derived->source.volume, moments, options);
    if (!made) return pass_on(made);
    std::ranges::move(made->notes, std::back_inserter(derived->source.notes));
    return derived;
}

}  // namespace stormcellar::capi

using namespace stormcellar;

stormcellar_code stormcellar_volume_open(const char* path, const stormcellar_read_options* options,
                                         stormcellar_volume** volume, stormcellar_error* error) {
    return capi::guarded(error, [&]() -> Status {
        if (path == nullptr) return capi::is_null("path");
        Status opened =
            capi::open_with(options, volume, [&](const level2::DecodeOptions& decoding) {
                return level2::decode_file(path, decoding);
            });
        if (opened) (*volume)->file = std::filesystem::path{path}.filename().string();
        return opened;
    });
}

stormcellar_code stormcellar_volume_from_bytes(const void* bytes, size_t size,
                                               const stormcellar_read_options* options,
                                               stormcellar_volume** volume,
                                               stormcellar_error* error) {
    return capi::guarded(error, [&]() -> Status {
        if (bytes == nullptr && size > 0) return capi::is_null("bytes");
        return capi::open_with(options, volume, [&](const level2::DecodeOptions& decoding) {
            return level2::decode({static_cast<const std::byte*>(bytes), size}, decoding);
        });
    });
}

stormcellar_code stormcellar_volume_from_descriptor(int descriptor,
                                                    const stormcellar_read_options* options,
                                                    stormcellar_volume** volume,
                                                    stormcellar_error* error) {
    return capi::guarded(error, [&]() -> Status {
        return capi::open_with(
            options, volume, [&](const level2::DecodeOptions& decoding) -> Result<level2::Decoded> {
                const auto bytes = read_open_file(descriptor, "the descriptor", default_read_limit);
                if (!bytes) return pass_on(bytes);
                return level2::decode(*bytes, decoding);
            });
    });
}

void stormcellar_volume_free(stormcellar_volume* volume) {
    delete volume;
}

stormcellar_code stormcellar_volume_describe(const stormcellar_volume* volume,
                                             stormcellar_volume_facts* facts,
                                             stormcellar_error* error) {
    return capi::guarded(error, [&] { return capi::describe(volume, facts); });
}

stormcellar_code stormcellar_volume_problem(const stormcellar_volume* volume, int32_t problem,
                                            char* text, size_t size, stormcellar_error* error) {
    return capi::guarded(error, [&]() -> Status {
        if (volume == nullptr || text == nullptr)
            return capi::is_null(volume == nullptr ? "volume" : "text");
        if (problem < 0 || static_cast<std::size_t>(problem) >= volume->problems.size())
            return fail(ErrorCode::bad_argument, "there is no problem {}; there are {}", problem,
                        volume->problems.size());
        capi::copy_text(volume->problems[static_cast<std::size_t>(problem)], text, size);
        return {};
    });
}

stormcellar_code stormcellar_volume_derive(const stormcellar_volume* volume, const char* moments,
                                           const stormcellar_derive_options* options,
                                           stormcellar_volume** derived, stormcellar_error* error) {
    return capi::guarded(error, [&] { return capi::derive(volume, moments, options, derived); });
}
