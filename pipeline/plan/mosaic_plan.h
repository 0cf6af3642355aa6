// pipeline/plan/mosaic_plan.h -- the cheapest frame of several sites that holds a budget, and how
// large each effect is in it: what grid/plan/grid_effects.h does for one volume's grid.
//
// Sizes   gridding      the largest of all volumes', each predicted by itself (grid::predict()):
//                       a frame's cell is a mean of its volumes' cells, or one of them
//         time, sweeps, overlap
//                       values: whole frames of the default grids in fine codes, with the step at
//                       one rung against the next, every other step of these three exact; sampled
//                       they are not, for a moved cell comes from anywhere
//                       positions: how far the fastest echo moves between a volume's middle and
//                       the instant (echo_motion), between a sweep and its volume's middle
//                       (sweep_times); by the motion that the grids show
//         codes         proven: half a step for each time that a value is rounded: in its partial,
//                       between two volumes, where sites mix
// Measured is the whole frame against the exact chain's, over all cells valued in both, so that the
// 99th percentile is no estimate; its price is gridding every volume by the exact chain. Cells
// are moments of one number line: VEL and PHI are not planned.
// Threads: as the scene.
#pragma once

#include <optional>

#include "pipeline/mosaic/mosaic_scene.h"
#include "stormcellar/accuracy/budget.h"
#include "stormcellar/accuracy/plan.h"
#include "stormcellar/base/result.h"

namespace stormcellar::pipeline {

// Each effect's size and cost for this scene; settings stay. `chain` is of mosaic_effects_of().
// Errors: bad_argument for VEL and PHI; those of gridding and merging.
[[nodiscard]] Status predict(MosaicScene& scene, const grid::PlanOptions& options,
                             accuracy::Chain& chain);

// How far the fastest echo of any pair of volumes moves, by the motion that the grids show.
struct Displacements {
    double to_instant_m = 0;     // from a volume's middle
    double within_volume_m = 0;  // from a volume's middle to its first or last sweep
};
[[nodiscard]] Displacements displacements(const MosaicScene& scene);

struct MosaicPlan {
    accuracy::Plan plan;
    MosaicChoice choice;
};

// Predicts, chooses and measures (accuracy/governor.h). Without a budget: the default, with each
// effect's size. Errors: those of predict() and accuracy::govern().
[[nodiscard]] Result<MosaicPlan> plan_mosaic(MosaicScene& scene, accuracy::Chain chain,
                                             const std::optional<accuracy::Budget>& budget,
                                             const grid::PlanOptions& options = {});

}  // namespace stormcellar::pipeline
