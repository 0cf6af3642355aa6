// grid/place/source_volume.h -- a decoded volume with the place of its radar and what readers of a
// grid or a picture made of it should know.
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
    // What the radar reported to be wrong, as grids store it: "KTLX: standby, ...".
    std::vector<std::string> radar_troubles = {};
    double read_s = 0, decode_s = 0;
};

// Chooses cuts of a volume by its pattern; empty: all. The volume has no sweeps yet.
using ChooseCuts = std::function<std::vector<int>(const level2::Volume&)>;

// What is wanted of a file.
struct SourceWish {
    std::vector<level2::Moment> moments;  // any one of them will do
    ChooseCuts choose_cuts = {};
    // Gives the volume a name or a position that the file does not have.
    std::function<Status(level2::Volume&)> place = {};
    // Ends the message about a radar whose position is not known.
    std::string_view how_to_place = {};
    int threads = 1;
    int volume = 0;  // its number in the file, from 1; 0: the first that holds one of the moments
    // The volume that starts then is wanted, if the file holds several.
    std::optional<UtcTime> start = std::nullopt;
};

// Returns what to decode for the wish. The station in the name counts where the file names none.
[[nodiscard]] level2::DecodeOptions decode_options_of(const SourceWish& wish,
                                                      const std::string& file_name);

// Decodes the bytes of a file; with `choose_cuts` only the sweeps of these cuts, and all sweeps
// where that gives none with a moment. Errors: those of decoding, naming the file.
[[nodiscard]] Result<level2::Decoded> decode_wished(std::span<const std::byte> bytes,
                                                    const std::string& file,
                                                    const level2::DecodeOptions& options,
                                                    const ChooseCuts& choose_cuts);

// Takes the volume of the number or the start that is wanted, or the first that holds one of the
// moments. Errors name the file: bad_argument if it has not so many volumes; those of `place`;
// not_found if none of several starts then, or the position of the radar is not known.
[[nodiscard]] Result<SourceVolume> take_source(level2::Decoded decoded, const std::string& file,
                                               const SourceWish& wish);

// Both, for a file whose path or name is `file`.
[[nodiscard]] Result<SourceVolume> decode_source(std::span<const std::byte> bytes,
                                                 const std::string& file, const SourceWish& wish);

}  // namespace stormcellar::grid
