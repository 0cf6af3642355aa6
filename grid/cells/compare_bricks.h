// grid/cells/compare_bricks.h -- how two grids of the same cells differ, cell by cell.
//
// The grids may be made in different ways and have different quantizations: for example, a mosaic
// by a cheap chain and the same mosaic by the exact chain (pipeline/plan/mosaic_plan.h). Do not
// compare moments that wrap (VEL, PHI), because values are subtracted as plain numbers.
//
// Threads   Pure; the result is the same for any number of threads.
#pragma once

#include <vector>

#include "stormcellar/accuracy/error_statistics.h"
#include "stormcellar/base/result.h"
#include "stormcellar/grid/brick_view.h"

namespace stormcellar::grid {

struct BrickDifferences {
    std::vector<float> values;  // a - b of each cell with a value in both, in the order of bricks
    accuracy::StatusCounts status;  // over cells that at least one of the two grids has seen

    // Summarizes the magnitudes of all differences; none if no cell has a value in both grids.
    [[nodiscard]] std::optional<accuracy::ErrorSummary> summary() const;
};

// Compares two grids. Errors: bad_argument for grids with different specs.
[[nodiscard]] Result<BrickDifferences> compare_bricks(const BrickView& a, const BrickView& b,
                                                      int threads);

}  // namespace stormcellar::grid
