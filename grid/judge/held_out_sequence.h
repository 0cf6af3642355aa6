// grid/judge/held_out_sequence.h -- a sequence of volumes, each held out in turn and made again
// from its neighbors (grid/judge/held_out.h).
//
// Threads   Each call works alone and starts up to `threads` threads of its own.
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

// One volume of a sequence, and the name under which it is reported.
struct TimedVolume {
    level2::Volume volume;
    SitePosition site;
    std::string name;
};

// A volume can be held out only if it has a neighbor before it and one after it.
inline constexpr std::size_t least_sequence = 3;

// Returns the repeated cuts (SAILS, MRLE) of a volume's lowest elevation, each as a volume of its
// own. Errors: not_found if there are fewer than three.
[[nodiscard]] Result<std::vector<TimedVolume>> repeats_of(const level2::Volume& volume,
                                                          const SitePosition& site,
                                                          level2::Moment moment);

struct HeldOutRow {
    std::string name;                  // the held-out volume
    double before_s = 0, after_s = 0;  // from the middles of the neighbors to its own middle
    HeldOut held_out;
};

// Returns one row for each volume that has two neighbors. All volumes are of one site, in order of
// time. The calling thread calls `progress`, if it is set, after each grid and after each score.
// Errors are those of make_grid() and score_held_out(), and name the volume.
[[nodiscard]] Result<std::vector<HeldOutRow>> score_sequence(
    const std::vector<TimedVolume>& sequence, const GridSpec& spec, const GridderOptions& options,
    const std::function<void(std::size_t done, std::size_t total)>& progress = {});

}  // namespace stormcellar::grid
