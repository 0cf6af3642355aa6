// pipeline/plan/mosaic_ladder.h -- measures the time that accuracy costs in merging volumes into a
// frame, rung by rung, for the steps of pipeline/mosaic/mosaic_effects.h that are not in
// grid/plan/grid_ladder.h.
//
// Each of these steps has a row for each rung. A row has the difference between two frames, over
// all cells with a value in both: the frame with this rung and every other step exact, and the
// frame of the exact chain. The row also has the time of making a frame from kept partials, with
// the other steps at their default. Rows of the step "chain" are whole chains; their time includes
// gridding every volume. Times are processor time for one thread, wall time for several.
//
// A position error is the distance that the fastest echo moves (pipeline/plan/mosaic_plan.h). Whole
// chains have no position error, because the error of beams is of another kind.
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

// Measures the ladder. `chain` must come from mosaic_effects_of(). Each time is the least of
// `rounds` timings. `progress`, if set, is called from the calling thread after each frame. Errors:
// those of the scene.
[[nodiscard]] Result<std::vector<accuracy::LadderRow>> run_ladder(
    MosaicScene& scene, const accuracy::Chain& chain, int rounds,
    const std::function<void(std::size_t done, std::size_t total)>& progress = {});

}  // namespace stormcellar::pipeline
