// cli/grid/grid_report.h -- reports on the grids that `stormcellar grid` wrote.
//
// Threads   Pure, except that print_facts() prints.
#pragma once

#include <vector>

#include <nlohmann/json.hpp>

#include "cli/grid/grid_request.h"
#include "stormcellar/grid/grid.h"

namespace stormcellar::cli {

// Wall-clock seconds of each phase, summed over all moments.
struct GridTimings {
    double read_s = 0, decode_s = 0, geometry_s = 0, plan_s = 0, grid_s = 0, merge_s = 0;
    double write_s = 0, total_s = 0;
};

// Returns facts about the grids, which have one or several moments on the same cells. For one grid,
// all facts are in one object. For several grids, "moments" has an object for each.
[[nodiscard]] nlohmann::ordered_json describe(const GridOptions& options,
                                              const std::vector<grid::Grid>& grids,
                                              const GridTimings& timings);

// Prints the facts of describe() as text. Prints to standard error if the grid goes to standard
// output.
void print_facts(const GridOptions& options, const std::vector<grid::Grid>& grids,
                 const GridTimings& timings);

}  // namespace stormcellar::cli
