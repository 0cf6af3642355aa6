// synth/compare_with_truth.h -- measures how far grids are from the truth of a simulated scene.
//
// The difference is sampling error: echo that the radar did not see, and changes of the storm
// during the volume. The truth is taken at the center of each cell, in the middle of the volume's
// time. A cell counts if it has a value and the truth there is above the weakest echo (-20 dBZ).
//
// Threads   One thread at a time. It starts as many threads as the scene asks for.
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
    double mean = 0;  // of the signed errors
    // Share of the seen cells with a truth above 5 dBZ that have no value.
    double echo_missed = 0;
    double echo_invented = 0;  // share of the cells above 5 dBZ whose truth is below -5 dBZ
};

// Returns one row for each chain of the ladder whose beams, like those of the simulation, are over
// a 4/3 earth. Errors: those of gridding.
[[nodiscard]] Result<std::vector<TruthRow>> compare_with_truth(grid::GridScene& scene,
                                                               const Scene& truth,
                                                               std::size_t columns);
}  // namespace stormcellar::synth
