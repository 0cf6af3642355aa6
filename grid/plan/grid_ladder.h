// grid/plan/grid_ladder.h -- measures the time and the error of each rung on one scene.
//
// A step of gridding, such as the beam, can be done in several ways, which are its rungs. Each rung
// of each step has a row. The error in the row is the difference from the exact form of the chain,
// with every other step exact, over sampled columns. The time in the row is the time of a whole
// grid with the other steps at their default. So the difference between two rows is what a user
// pays for the better rung. A row of the step "chain" is a whole chain with its own time and error;
// these rows include the default methods.
//
// A position error of the frame covers the sampled columns. A position error of the beam covers
// gates of the sweeps, and a position error of the elevation covers the radials. Times are for one
// thread unless the scene has more threads.
//
// Threads   The rules of the scene apply (grid/plan/grid_scene.h).
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
    int rounds = 3;  // number of timings; the smallest time counts
    std::uint64_t seed = 1;
    Averaging averaging = Averaging::in_db;  // of all chains, including the exact form
    // Receives the number of finished rows and the number of all rows. May be null.
    std::function<void(std::size_t done, std::size_t total)> progress = {};
};

struct NamedChain {
    std::string name;
    SceneChoice choice;
};
// Returns the chains: nearest, linear, ..., area and exact. For REF, also returns the chain `area`
// with the other averaging.
[[nodiscard]] std::vector<NamedChain> named_chains(level2::Moment moment, Averaging averaging);

[[nodiscard]] Result<std::vector<accuracy::LadderRow>> run_ladder(GridScene& scene,
                                                                  const LadderOptions& options);

}  // namespace stormcellar::grid
