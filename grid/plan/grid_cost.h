// grid/plan/grid_cost.h -- predicts how long the grid of a scene takes with any choice of rungs, by
// timing parts of the grid.
//
// The time of a grid is the sum of four parts: its tiles; the tables of its sweeps; its geometry,
// if that uses exact geodesics; and a rest, which is the same for all choices and is known from the
// base of the scene. Tiles differ: tiles with echo take longer than clear air, and cells with an
// extent take longest near the radar, where gates are dense. So tiles are drawn from two strata,
// each evenly along the arc: tiles where a cell may hold a value, and the other tiles within reach.
// Each stratum is timed separately, and the time is scaled to its number of tiles. The times of an
// interpolation and an extent do not add up, so every pair of the two is timed
// (accuracy::JointCost).
//
// Accuracy  The aim is to be within a factor of 1.5 of the real time. bench/bench_plan.cpp measures
//           this over real volumes (docs/performance.md). No test enforces it, because it depends
//           on a clock. For one thread the prediction is processor time, which equals elapsed time
//           if the processor is free.
// Threads   The rules of the scene apply (grid/plan/grid_scene.h).
#pragma once

#include "grid/plan/grid_scene.h"
#include "stormcellar/accuracy/chain.h"

namespace stormcellar::grid {

// The tiles to time, and how many tiles each stratum has in all.
struct TileSample {
    struct Stratum {
        std::vector<Tile> tiles;
        std::size_t count = 0;
    };
    Stratum with_echo, without;
};
// Draws up to `of_each` tiles from each stratum.
[[nodiscard]] TileSample draw_tiles(GridScene& scene, std::size_t of_each);

// Predicts from the sample how many seconds it takes to fill the whole grid by this method.
[[nodiscard]] Result<double> predicted_fill_s(GridScene& scene, const Method& method,
                                              const TileSample& sample);

// Sets all costs in a chain of effects_of(), for the moment of the scene: the costs of effects, the
// joint costs, and the cost of the cheapest choice.
[[nodiscard]] Status predict_costs(GridScene& scene, accuracy::Chain& chain);

}  // namespace stormcellar::grid
