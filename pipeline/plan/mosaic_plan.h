// pipeline/plan/mosaic_plan.h -- finds the cheapest frame of several sites within a budget, and the
// size of each effect in it. grid/plan/grid_effects.h does the same for the grid of one volume.
//
// Sizes are found as follows:
//   gridding  The largest of the sizes that grid::predict() finds for each volume, because a cell
//             of a frame is one cell of its volumes or a mean of such cells.
//   time, sweeps, overlap
//             The error of values is the difference between two whole frames of the default grids
//             in fine codes. One frame has the step at this rung, the other frame at the next rung;
//             the other two steps are exact. Frames are not sampled, because a cell that moved may
//             come from anywhere. The error of positions is the distance that the fastest echo
//             moves, by the motion that the grids show: between a volume's middle and the instant
//             (echo_motion), or between a sweep and its volume's middle (sweep_times).
//   codes     A proven bound: half a step for each time that a value is rounded (in its partial,
//             between two volumes, and where sites mix).
// The chosen frame is compared with the frame of the exact chain, over all cells with a value in
// both, so its 99th percentile is not an estimate. For that, every volume must be gridded by the
// exact chain. VEL and PHI cannot be planned, because their values wrap.
//
// Threads   As for the scene.
#pragma once

#include <optional>

#include "pipeline/mosaic/mosaic_scene.h"
#include "stormcellar/accuracy/budget.h"
#include "stormcellar/accuracy/plan.h"
#include "stormcellar/base/result.h"

namespace stormcellar::pipeline {

// Predicts the size and cost of each effect for this scene. Does not change settings. `chain` must
// come from mosaic_effects_of(). Errors: bad_argument for VEL and PHI; those of gridding and
// merging.
[[nodiscard]] Status predict(MosaicScene& scene, const grid::PlanOptions& options,
                             accuracy::Chain& chain);

// The distances that the fastest echo in any pair of volumes moves. The motion is what the grids
// show.
struct Displacements {
    double to_instant_m = 0;     // from a volume's middle
    double within_volume_m = 0;  // from a volume's middle to its first or last sweep
};
[[nodiscard]] Displacements displacements(const MosaicScene& scene);

struct MosaicPlan {
    accuracy::Plan plan;
    MosaicChoice choice;
};

// Predicts, chooses and measures (accuracy/governor.h). Without a budget, the plan has the default
// choice and the size of each effect. Errors: those of predict() and of accuracy::govern().
[[nodiscard]] Result<MosaicPlan> plan_mosaic(MosaicScene& scene, accuracy::Chain chain,
                                             const std::optional<accuracy::Budget>& budget,
                                             const grid::PlanOptions& options = {});

}  // namespace stormcellar::pipeline
