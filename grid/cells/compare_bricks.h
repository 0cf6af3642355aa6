// grid/cells/compare_bricks.h -- how two grids of the same cells differ, cell by cell.
//
// Whatever made them, and in whatever steps they keep values: a mosaic by a cheap chain against the
// same by the exact one (pipeline/plan/mosaic_plan.h). Not for what wraps (VEL, PHI): differences
// go the straight way. Threads: the same result for any number of threads.
#pragma once

#include <vector>

#include "stormcellar/accuracy/error_statistics.h"
#include "stormcellar/base/result.h"
#include "stormcellar/grid/brick_view.h"

namespace stormcellar::grid {

struct BrickDifferences {
    std::vector<float> values;      // a - b of each cell valued in both, in the order of bricks
    accuracy::StatusCounts status;  // of the cells that at least one of both has seen

    // Of the magnitudes of all cells; none where no cell is valued in both.
    [[nodiscard]] std::optional<accuracy::ErrorSummary> summary() const;
};

// bad_argument: grids of different specs.
[[nodiscard]] Result<BrickDifferences> compare_bricks(const BrickView& a, const BrickView& b,
                                                      int threads);

}  // namespace stormcellar::grid
