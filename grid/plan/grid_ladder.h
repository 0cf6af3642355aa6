// grid/plan/grid_ladder.h -- what accuracy costs in time, rung by rung, on one scene.
//
// Each rung of each step has a row. It has the error of the rung with every other step exact,
// against the exact form of the chain, over sampled columns. It also has the time of a whole grid
// with the other steps at their default, because that is what changes when a user goes up or down
// this ladder. Rows of the step "chain" are whole chains, including the default methods, with their
// own times and errors.
//
// Position errors of the frame cover the sampled columns, those of the beam the gates of the
// sweeps, and those of the elevation the radials. Times are single-threaded unless the scene has
// more threads.
//
// Threads   As for the scene (grid/plan/grid_scene.h).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "grid/plan/grid_effects.h"
#include "grid/plan/grid_scene.h"
#include "stormcellar/accuracy/ladder.h"
#include "stormcellar/base/result.h"

namespace stormcellar::grid {

struct LadderOptions {
    std::size_t columns = 2000;
    int rounds = 3;  // rounds of timing; the least time counts
    std::uint64_t seed = 1;
    Averaging averaging = Averaging::in_db;  // of all chains, the exact form too
    // Receives the number of rows that are done and the number in all; may be null.
    std::function<void(std::size_t done, std::size_t total)> progress = {};
};

// A whole chain with a name of its own.
struct NamedChain {
    std::string name;
    SceneChoice choice;
};
// Returns nearest, linear, ..., area, (for REF) area with the other averaging, and the exact chain.
[[nodiscard]] std::vector<NamedChain> named_chains(level2::Moment moment, Averaging averaging);

[[nodiscard]] Result<std::vector<accuracy::LadderRow>> run_ladder(GridScene& scene,
                                                                  const LadderOptions& options);

}  // namespace stormcellar::grid
