// pipeline/plan/mosaic_ladder.h -- what accuracy costs in time when volumes become one frame, rung
// by rung: the steps of pipeline/mosaic/mosaic_effects.h that grid/plan/grid_ladder.h does not
// have.
//
// For each of them a row a rung: its error with every other step exact, against the frame by the
// exact chain, over all cells valued in both; its time as a frame from partials of the default
// chain that are kept, with the other steps at their default. Rows of the step "chain" are whole
// chains, whose time is that of gridding every volume too. Of one thread it is time of the
// processor, of several by the clock.
// Position errors are how far the fastest echo moves (pipeline/plan/mosaic_plan.h); whole chains
// have none: that of beams is another one.
#pragma once

#include <vector>

#include "pipeline/mosaic/mosaic_scene.h"
#include "stormcellar/accuracy/ladder.h"
#include "stormcellar/base/result.h"

namespace stormcellar::pipeline {

// `chain` is of mosaic_effects_of(); `rounds` of timing, the least counts.
// Errors: those of the scene.
[[nodiscard]] Result<std::vector<accuracy::LadderRow>> run_ladder(MosaicScene& scene,
                                                                  const accuracy::Chain& chain,
                                                                  int rounds);

}  // namespace stormcellar::pipeline
