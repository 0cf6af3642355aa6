// retrieve/cells/peak_flood.h -- divides strong echo among its peaks: a watershed by falling
// reflectivity in which weak and near peaks join their stronger neighbors.
//
// Threads   A pure function. The order of the cells decides ties, so the result is always the same.
#pragma once

#include <cstdint>
#include <vector>

#include "retrieve/cells/strong_echo.h"

namespace stormcellar::retrieve {

// Two groups that meet stay apart if the weaker peak rises by `prominence_db` above the place where
// they meet, the peaks are `separation_m` apart, and the weaker group has `least_cells` by then.
struct FloodRules {
    float prominence_db = 0;
    double separation_m = 0;
    int least_cells = 0;
    double cell_width_m = 0, cell_height_m = 0;
};

// The groups of cells. `group_of` has a group for each cell of the echo, numbered from the
// strongest peak down.
struct FloodedEcho {
    int groups = 0;
    std::vector<std::int32_t> group_of;
};
[[nodiscard]] FloodedEcho flood_peaks(const StrongEcho& echo, const FloodRules& rules);

}  // namespace stormcellar::retrieve
