// grid/plan/grid_ladder.h -- measures the time and the error of each rung on one scene.
//
// A step of gridding, such as the beam, can be done in several ways, its rungs. Each rung of each
// step has a row. The row's error is against the exact form of the chain, with every other step
// exact, over sampled columns. The row's time is the time of a whole grid with the other steps at
// their default, so a difference of two rows is what a user pays for the better rung. Rows of the
// step "chain" are whole chains, including the default methods, with their own times and errors.
//
// Position errors of the frame cover the sampled columns, position errors of the beam cover the
// gates of the sweeps, and position errors of the elevation cover the radials. Times are
// single-threaded unless the scene has more threads.
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
    Averaging averaging = Averaging::in_db;  // of all chains, including the exact form
    // Receives the number of finished rows and of all rows; may be null.
    std::function<void(std::size_t done, std::size_t total)> progress = {};
};

struct NamedChain {
    std::string name;
    SceneChoice choice;
};
// Returns the chains nearest, linear, ..., area and exact; for REF also area with the other
// averaging.
[[nodiscard]] std::vector<NamedChain> named_chains(level2::Moment moment, Averaging averaging);

[[nodiscard]] Result<std::vector<accuracy::LadderRow>> run_ladder(GridScene& scene,
                                                                  const LadderOptions& options);

}  // namespace stormcellar::grid
