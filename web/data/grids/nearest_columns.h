// web/data/grids/nearest_columns.h -- resamples a grid onto the columns of another plane. Each
// column of the plane takes the states and codes of the nearest column of the grid.
//
// Threads   Any thread may call lay().
// Errors    None. Columns beyond the grid are not seen.
// Accuracy  Echo moves by at most half the diagonal of a column of the grid.
#pragma once

#include <cstdint>
#include <vector>

#include "stormcellar/grid/brick_grid.h"

namespace stormcellar::web {

class NearestColumns {
  public:
    // Finds the nearest column of grids with the spec `from`, for each column of `plane`.
    NearestColumns(const grid::GridSpec& from, const grid::GridSpec& plane);

    // Returns the grid on the plane. The grid must have the spec `from` of the constructor. This
    // spec and the plane must have the same number of levels.
    [[nodiscard]] grid::BrickGrid lay(const grid::BrickView& from) const;

  private:
    struct Column {
        std::int32_t x = -1, y = -1;  // negative: none
    };
    template <class Code>
    void lay(const grid::BrickView& from, grid::BrickGrid& laid) const;

    grid::GridSpec plane_;
    std::vector<Column> columns_;  // y fastest
};

}  // namespace stormcellar::web
