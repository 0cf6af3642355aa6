// cli/grid/grid_report.h -- what `stormcellar grid` says of the grids that it wrote.
//
// Threads   Pure, but for the output of print_facts().
#pragma once

#include <vector>

#include <nlohmann/json.hpp>

#include "cli/grid/grid_request.h"
#include "stormcellar/grid/grid.h"

namespace stormcellar::cli {

// Seconds of wall time for each phase, over all moments.
struct GridTimings {
    double read_s = 0, decode_s = 0, geometry_s = 0, plan_s = 0, grid_s = 0, merge_s = 0;
    double write_s = 0, total_s = 0;
};

// Returns the facts of grids of one or several moments of the same cells. Of one grid everything
// stands side by side; of several, "moments" has an object for each.
[[nodiscard]] nlohmann::ordered_json describe(const GridOptions& options,
                                              const std::vector<grid::Grid>& grids,
                                              const GridTimings& timings);

// Prints the same in words: to standard error if the file goes to standard output.
void print_facts(const GridOptions& options, const std::vector<grid::Grid>& grids,
                 const GridTimings& timings);

}  // namespace stormcellar::cli
