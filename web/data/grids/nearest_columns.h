// web/data/grids/nearest_columns.h -- a grid laid on the columns of another plane: each column
// there is the nearest one of the grid, state and code unchanged.
//
// Threads   Any thread may call lay().
// Errors    None. Columns that lie beyond the grid are not seen.
// Accuracy  A place is off by at most half a diagonal of a column of the grid.
#pragma once

#include <cstdint>
#include <vector>

#include "stormcellar/grid/brick_grid.h"

namespace stormcellar::web {

class NearestColumns {
  public:
    // Finds for each column of `plane` the nearest one of grids with the spec `from`.
    NearestColumns(const grid::GridSpec& from, const grid::GridSpec& plane);

    // The grid must have the spec `from`; both specs must have as many levels.
    [[nodiscard]] grid::BrickGrid lay(const grid::BrickView& from) const;

  private:
    struct Column {
        std::int32_t x = -1, y = -1;  // less than 0: none
    };
    template <class Code>
    void lay(const grid::BrickView& from, grid::BrickGrid& laid) const;

    grid::GridSpec plane_;
    std::vector<Column> columns_;  // y fastest
};

}  // namespace stormcellar::web
