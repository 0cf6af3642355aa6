// grid/judge/held_out_sequence.h -- a sequence of volumes, each held out in turn and made again
// from its neighbors (grid/judge/held_out.h).
//
// Thread contract: each call works alone; it starts up to `threads` threads of its own.
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

// Holding a volume out takes a neighbor before it and one after it.
inline constexpr std::size_t least_sequence = 3;

// Returns the repeated cuts (SAILS, MRLE) of a volume's lowest elevation, each as a volume of its
// own. Errors: not_found if there are fewer than three.
[[nodiscard]] Result<std::vector<TimedVolume>> repeats_of(const level2::Volume& volume,
                                                          const SitePosition& site,
                                                          level2::Moment moment);

struct HeldOutRow {
    std::string name;                  // of what was held out
    double before_s = 0, after_s = 0;  // from the neighbors' middles to its own
    HeldOut held_out;
};

// One row for each volume that has two neighbors. All volumes are of one site, in order of time.
// `progress`, if there is one, is called from the calling thread after each piece of work: a grid
// of each volume, then a score of each held-out one. Errors name the volume: those of make_grid()
// and score_held_out().
[[nodiscard]] Result<std::vector<HeldOutRow>> score_sequence(
    const std::vector<TimedVolume>& sequence, const GridSpec& spec, const GridderOptions& options,
    const std::function<void(std::size_t done, std::size_t total)>& progress = {});

}  // namespace stormcellar::grid
