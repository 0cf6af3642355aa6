// grid/plan/grid_cost.h -- how long a scene's grid takes by any choice of rungs, from timing parts
// of it.
//
// A grid takes the time of its tiles, of the tables of its sweeps, of its geometry where that is by
// exact geodesics, and what is left, which is alike for all choices and known from the scene's
// base. Tiles are not alike: with echo they take more than clear air, and cells with an extent take
// most near the radar, where gates are dense. So tiles are drawn in two strata, those where a cell
// may hold a value and those within reach that hold none, each evenly along the arc; each is timed
// by itself and scaled by its own number. What interpolation and extent take together is not the
// sum of what each takes, so that every pair of them is timed (accuracy::JointCost).
//
// Accuracy  meant to be within 1.5 of the time that gridding then takes; measured over real volumes
//           by bench/bench_plan.cpp (docs/performance.md). No test holds it: it is a clock's word.
//           Of one thread it is time of the processor, as it passes where nobody else needs it.
// Threads   as the scene (grid/plan/grid_scene.h).
#pragma once

#include "grid/plan/grid_scene.h"
#include "stormcellar/accuracy/chain.h"

namespace stormcellar::grid {

// Tiles to time, and how many each stratum has in all.
struct TileSample {
    struct Stratum {
        std::vector<Tile> tiles;
        std::size_t count = 0;
    };
    Stratum with_echo, without;
};
// Up to so many of each stratum, spread over threads alike.
[[nodiscard]] TileSample draw_tiles(GridScene& scene, std::size_t of_each);

// Seconds that filling the whole grid by this method takes, by the sample.
[[nodiscard]] Result<double> predicted_fill_s(GridScene& scene, const Method& method,
                                              const TileSample& sample);

// Sets all costs of a chain of effects_of() the scene's moment: those of its effects, jointly, and
// of the cheapest choice.
[[nodiscard]] Status predict_costs(GridScene& scene, accuracy::Chain& chain);

}  // namespace stormcellar::grid
