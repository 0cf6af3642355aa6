// grid/cells/compare_bricks.h -- compares two grids of the same cells, cell by cell.
//
// The grids may be made in different ways and have different quantizations. For example, one is a
// mosaic by a cheap chain and the other the same mosaic by the exact chain
// (pipeline/plan/mosaic_plan.h). Do not compare moments that wrap (VEL, PHI), because values are
// subtracted as plain numbers.
//
// Threads   Pure. The result is the same for any number of threads.
#pragma once

#include <vector>

#include "stormcellar/accuracy/error_statistics.h"
#include "stormcellar/base/result.h"
#include "stormcellar/grid/brick_view.h"

namespace stormcellar::grid {

struct BrickDifferences {
    // a - b for cells with a value in both grids, in the order of bricks.
    std::vector<float> values;
    accuracy::StatusCounts status;  // counts the cells that at least one of the grids has seen

    // Summarizes the magnitudes of all differences. Returns none if no cell has a value in both
    // grids.
    [[nodiscard]] std::optional<accuracy::ErrorSummary> summary() const;
};

// Compares two grids. Errors: bad_argument for grids with different specs.
[[nodiscard]] Result<BrickDifferences> compare_bricks(const BrickView& a, const BrickView& b,
                                                      int threads);

}  // namespace stormcellar::grid
