// grid/plan/grid_ladder.h -- what accuracy costs in time, rung by rung, on one scene.
//
// For each step a row a rung: its error with every other step exact, against the chain's exact
// form, over sampled columns; its time as a whole grid with the other steps at their default, since
// that is what going up or down this ladder changes. Rows of the step "chain" are whole chains, the
// default methods among them, with their own times and errors.
// Position errors: of the frame over the sampled columns; of the beam over gates of the sweeps;
// of the elevation over the radials. Times are single-threaded unless the scene has more threads.
#pragma once

#include <vector>

#include "grid/plan/grid_effects.h"
#include "grid/plan/grid_scene.h"
#include "stormcellar/accuracy/ladder.h"
#include "stormcellar/base/result.h"

namespace stormcellar::grid {

struct LadderOptions {
    std::size_t columns = 2000;
    int rounds = 3;  // of timing; the least counts
    std::uint64_t seed = 1;
    Averaging averaging = Averaging::in_db;  // of all, the exact form too
};

// A whole chain with a name of its own.
struct NamedChain {
    const char* name;
    SceneChoice choice;
};
// Nearest, linear, ... area, (REF) area with the other averaging, and the exact chain.
[[nodiscard]] std::vector<NamedChain> named_chains(level2::Moment moment, Averaging averaging);

[[nodiscard]] Result<std::vector<accuracy::LadderRow>> run_ladder(GridScene& scene,
                                                                  const LadderOptions& options);

}  // namespace stormcellar::grid
