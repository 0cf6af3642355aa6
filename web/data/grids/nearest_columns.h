// web/data/grids/nearest_columns.h -- resamples a grid onto the columns of another plane. Each
// column there takes the states and codes of the grid's nearest column.
//
// Threads   Any thread may call lay().
// Errors    None. Columns beyond the grid are not seen.
// Accuracy  Echo is displaced by at most half the diagonal of a column of the grid.
#pragma once

#include <cstdint>
#include <vector>

#include "stormcellar/grid/brick_grid.h"

namespace stormcellar::web {

class NearestColumns {
  public:
    // Finds, for each column of `plane`, the nearest column of grids with the spec `from`.
    NearestColumns(const grid::GridSpec& from, const grid::GridSpec& plane);

    // Returns the grid on the plane. The grid must have the spec that the constructor got as
    // `from`; that spec and the plane must have equally many levels.
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
