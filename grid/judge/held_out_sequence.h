// grid/judge/held_out_sequence.h -- holds out each volume of a sequence in turn, and reconstructs
// it from its neighbors (grid/judge/held_out.h).
//
// Threads   Pure functions; each call starts up to `threads` threads of its own.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "grid/judge/held_out.h"
#include "stormcellar/base/result.h"
#include "stormcellar/grid/gridder.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::grid {

// A volume of a sequence, with its name in the report.
struct TimedVolume {
    level2::Volume volume;
    SitePosition site;
    std::string name;
};

// The least number of volumes in a sequence: the held-out volume, and a neighbor on each side of
// it.
inline constexpr std::size_t least_sequence = 3;

// Returns the repeated cuts (SAILS, MRLE) of the volume's lowest elevation, each as a volume of its
// own. Errors: not_found if there are fewer than three.
[[nodiscard]] Result<std::vector<TimedVolume>> repeats_of(const level2::Volume& volume,
                                                          const SitePosition& site,
                                                          level2::Moment moment);

struct HeldOutRow {
    std::string name;                  // name of the held-out volume
    double before_s = 0, after_s = 0;  // seconds from its middle time to each neighbor's
    HeldOut held_out;
};

// Returns one row for each volume that has two neighbors. All volumes must be of one site, in order
// of time. Calls `progress`, if it is set, after each grid and after each score, on the calling
// thread. Errors: those of make_grid() and score_held_out(), with the name of the volume.
[[nodiscard]] Result<std::vector<HeldOutRow>> score_sequence(
    const std::vector<TimedVolume>& sequence, const GridSpec& spec, const GridderOptions& options,
    const std::function<void(std::size_t done, std::size_t total)>& progress = {});

}  // namespace stormcellar::grid
