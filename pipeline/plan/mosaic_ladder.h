// pipeline/plan/mosaic_ladder.h -- measures the time that accuracy costs when volumes are merged
// into a frame. It does so rung by rung, for the steps of pipeline/mosaic/mosaic_effects.h that
// grid/plan/grid_ladder.h does not have.
//
// Each of these steps has a row for each rung. A row has the difference between two frames, over
// all cells with a value in both. One frame has this rung and is exact in every other step; the
// other frame is made by the exact chain. The row also has the time of making a frame from kept
// partials, with the other steps at their default. Rows of the step "chain" are whole chains; their
// time includes gridding every volume. Times are processor time for one thread, and wall time for
// several.
//
// A position error is the distance that the fastest echo moves (pipeline/plan/mosaic_plan.h). Whole
// chains have no position error, because the position error of beams is of another kind.
//
// Threads   As for the scene.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "pipeline/mosaic/mosaic_scene.h"
#include "stormcellar/accuracy/ladder.h"
#include "stormcellar/base/result.h"

namespace stormcellar::pipeline {

// Measures the ladder. `chain` must come from mosaic_effects_of(). Each time is the smallest of
// `rounds` timings. `progress`, if set, is called after each frame, on the calling thread. Errors:
// those of the scene.
[[nodiscard]] Result<std::vector<accuracy::LadderRow>> run_ladder(
    MosaicScene& scene, const accuracy::Chain& chain, int rounds,
    const std::function<void(std::size_t done, std::size_t total)>& progress = {});

}  // namespace stormcellar::pipeline
