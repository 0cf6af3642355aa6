// pipeline/plan/mosaic_ladder.h -- measures the time that accuracy costs in merging volumes into a
// frame, rung by rung, for the steps of pipeline/mosaic/mosaic_effects.h that are not in
// grid/plan/grid_ladder.h.
//
// Each of these steps has a row for each rung. A row has the error of the rung with every other
// step exact, against the frame of the exact chain, over all cells with a value in both; and the
// time of a frame from kept partials of the default chain, with the other steps at their default.
// Rows of the step "chain" are whole chains; their time includes gridding every volume. Times are
// processor time for one thread, wall time for several.
//
// Position errors are how far the fastest echo moves (pipeline/plan/mosaic_plan.h). Whole chains
// have none, because the error of beams is of another kind.
//
// Threads   Those of the scene.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "pipeline/mosaic/mosaic_scene.h"
#include "stormcellar/accuracy/ladder.h"
#include "stormcellar/base/result.h"

namespace stormcellar::pipeline {

// Measures the ladder. `chain` must come from mosaic_effects_of(). The least of `rounds` timings
// counts. `progress`, if set, is called from the calling thread after each frame. Errors: those of
// the scene.
[[nodiscard]] Result<std::vector<accuracy::LadderRow>> run_ladder(
    MosaicScene& scene, const accuracy::Chain& chain, int rounds,
    const std::function<void(std::size_t done, std::size_t total)>& progress = {});

}  // namespace stormcellar::pipeline
