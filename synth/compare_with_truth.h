// synth/compare_with_truth.h -- measures how far grids are from the truth of a simulated scene.
//
// The difference is sampling error: echo that the radar did not see, and changes of the storm
// during the volume. The truth is taken at each cell's center, in the middle of the volume's time.
// A cell counts if it holds a value and the truth there is above the weakest echo (-20 dBZ).
//
// Threads   One thread at a time, which starts as many threads as the scene asks for.
#pragma once

#include <string>
#include <vector>

#include "grid/plan/grid_scene.h"
#include "stormcellar/accuracy/error_statistics.h"
#include "stormcellar/base/result.h"
#include "synth/synth_scene.h"

namespace stormcellar::synth {

struct TruthRow {
    std::string chain;
    accuracy::ErrorSummary error;
    double mean = 0;           // of the signed errors
    double echo_missed = 0;    // of seen cells with a truth above 5 dBZ, share without a value
    double echo_invented = 0;  // of cells above 5 dBZ, share with a truth below -5 dBZ
};

// Returns one row for each chain of the ladder with beams over a 4/3 earth, as in the simulation.
// Errors: those of gridding.
[[nodiscard]] Result<std::vector<TruthRow>> compare_with_truth(grid::GridScene& scene,
                                                               const Scene& truth,
                                                               std::size_t columns);
}  // namespace stormcellar::synth
