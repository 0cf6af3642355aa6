// pipeline/plan/mosaic_ladder.h -- what accuracy costs in time when volumes become one frame, rung
// by rung: for the steps of pipeline/mosaic/mosaic_effects.h that grid/plan/grid_ladder.h does not
// have.
//
// For each of these steps there is a row for each rung. It has the error of the rung with every
// other step exact, against the frame of the exact chain, over all cells with a value in both; and
// the time of a frame from kept partials of the default chain, with the other steps at their
// default. Rows of the step "chain" are whole chains, whose time includes gridding every volume.
// For one thread it is processor time, for several time by the clock.
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

// `chain` must come from mosaic_effects_of(). The least of `rounds` timings counts. `progress`, if
// there is one, is called from the calling thread after each frame that was made. Errors: those of
// the scene.
[[nodiscard]] Result<std::vector<accuracy::LadderRow>> run_ladder(
    MosaicScene& scene, const accuracy::Chain& chain, int rounds,
    const std::function<void(std::size_t done, std::size_t total)>& progress = {});

}  // namespace stormcellar::pipeline
