// grid/place/source_volume.h -- a decoded volume with the position of its radar. Its notes are for
// readers of a grid or a picture that is made from it.
//
// Threads   Plain data and pure functions; decoding uses `threads` threads of its own.
// Errors    See each function.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/grid/grid.h"
#include "stormcellar/level2/decode.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::grid {

struct SourceVolume {
    level2::Volume volume;
    SitePosition site;
    bool partial = false;
    std::vector<std::string> notes;  // for readers of the result
    // Faults that the radar reported, as in Provenance::radar_troubles: "KTLX: standby, ...".
    std::vector<std::string> radar_troubles = {};
    double read_s = 0, decode_s = 0;
};

// Chooses cuts by the volume's pattern. An empty result means all cuts. The volume has no sweeps
// yet when this is called.
using ChooseCuts = std::function<std::vector<int>(const level2::Volume&)>;

// Says which part of a file the caller wants, and how to complete it.
struct SourceWish {
    std::vector<level2::Moment> moments;  // the volume must hold one of these
    ChooseCuts choose_cuts = {};
    bool needs_all_moments = false;  // `derive` uses more than `moments`
    // Gives the volume a name or a position that the file lacks.
    std::function<Status(level2::Volume&)> place = {};
    // Adds derived moments, and returns notes about them. Called after `place`.
    std::function<Result<std::vector<std::string>>(level2::Volume&)> derive = {};
    // Ends the error message about a radar whose position is unknown.
    std::string_view how_to_place = {};
    int threads = 1;
    int volume = 0;  // number in the file, from 1; 0: the first that holds a moment
    // The start of the wanted volume. Ignored if the file has only one volume.
    std::optional<UtcTime> start = std::nullopt;
};

// Returns the options for decoding what the caller wants. If the file itself names no station, the
// station in `file_name` is used.
[[nodiscard]] level2::DecodeOptions decode_options_of(const SourceWish& wish,
                                                      const std::string& file_name);

// Decodes the bytes of a file. With `choose_cuts`, decodes only the chosen cuts. But decodes all
// sweeps if the file has no pattern, or several volumes, or if the chosen cuts hold none of the
// moments. Errors: those of decoding, with the name of the file.
[[nodiscard]] Result<level2::Decoded> decode_wished(std::span<const std::byte> bytes,
                                                    const std::string& file,
                                                    const level2::DecodeOptions& options,
                                                    const ChooseCuts& choose_cuts);

// Returns the volume with the wanted number or start, else the first volume that holds one of the
// moments, else the first volume. Errors, with the name of the file: bad_argument if the wanted
// number is above the number of volumes; not_found if none of several volumes has the wanted start,
// or if the position of the radar is unknown; those of `place` and `derive`.
[[nodiscard]] Result<SourceVolume> take_source(level2::Decoded decoded, const std::string& file,
                                               const SourceWish& wish);

// Calls decode_wished() and then take_source(). `file` is the path or the name of the file.
[[nodiscard]] Result<SourceVolume> decode_source(std::span<const std::byte> bytes,
                                                 const std::string& file, const SourceWish& wish);

}  // namespace stormcellar::grid
