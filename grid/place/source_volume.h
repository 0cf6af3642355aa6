// grid/place/source_volume.h -- a decoded volume with the place of its radar and notes for readers
// of a grid or a picture made from it.
//
// Threads   Plain data and functions without state; decoding uses `threads` threads of its own.
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
    std::vector<std::string> notes;  // what readers of the result should know
    // The faults that the radar reported, as grids store them: "KTLX: standby, ...".
    std::vector<std::string> radar_troubles = {};
    double read_s = 0, decode_s = 0;
};

// Chooses cuts of a volume by its pattern; an empty result means all cuts. The volume has no sweeps
// yet.
using ChooseCuts = std::function<std::vector<int>(const level2::Volume&)>;

// The part of a file that the caller wants.
struct SourceWish {
    std::vector<level2::Moment> moments;  // any one of them will do
    ChooseCuts choose_cuts = {};
    // Gives the volume a name or a position that the file does not have.
    std::function<Status(level2::Volume&)> place = {};
    // Ends the error message for a radar whose position is not known.
    std::string_view how_to_place = {};
    int threads = 1;
    int volume = 0;  // in the file, from 1; 0: the first with one of the moments
    // The start of the wanted volume, if the file holds several.
    std::optional<UtcTime> start = std::nullopt;
};

// Returns the decode options for the wish. If the file names no station, the station in the file
// name counts.
[[nodiscard]] level2::DecodeOptions decode_options_of(const SourceWish& wish,
                                                      const std::string& file_name);

// Decodes the bytes of a file. With `choose_cuts`, decodes only the sweeps of these cuts, or all
// sweeps if the cuts hold none of the moments. Errors are those of decoding, and name the file.
[[nodiscard]] Result<level2::Decoded> decode_wished(std::span<const std::byte> bytes,
                                                    const std::string& file,
                                                    const level2::DecodeOptions& options,
                                                    const ChooseCuts& choose_cuts);

// Takes the volume with the wanted number or start, or else the first that holds one of the
// moments. Errors name the file: bad_argument if it has fewer volumes; those of `place`; not_found
// if none of several volumes starts then, or if the position of the radar is not known.
[[nodiscard]] Result<SourceVolume> take_source(level2::Decoded decoded, const std::string& file,
                                               const SourceWish& wish);

// Decodes and takes the volume of a file whose path or name is `file`.
[[nodiscard]] Result<SourceVolume> decode_source(std::span<const std::byte> bytes,
                                                 const std::string& file, const SourceWish& wish);

}  // namespace stormcellar::grid
