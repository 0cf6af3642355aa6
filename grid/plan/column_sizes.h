// grid/plan/column_sizes.h -- estimates for each column how many of its cells may hold a value by
// any method of gridding.
//
// Columns are sampled in proportion to these sizes, and a column of size 0 is never compared. So a
// size must not be 0 where any method finds a value. The default method looks only at the center of
// a cell, but methods that take all gates of a cell also see gates between two centers.
//
// Threads   Pure.
// Accuracy  tests/grid/column_sizes_test.cpp compares with the exact form, on real volumes with
//           little echo: no column that holds a value has size 0.
#pragma once

#include <cstdint>
#include <vector>

#include "grid/sweep/sweep_stack.h"
#include "stormcellar/grid/column_geometry.h"
#include "stormcellar/grid/grid.h"

namespace stormcellar::grid {

// Returns the sizes. `base` is the grid by the default method, `stack` has its sweeps, and
// `geometry` its columns. Let `most` be the largest number of values in the column or one of its
// eight neighbors. If `most` is above 0, the size is 2 * most + 4, but at most the number of
// levels: other methods bring in values from neighboring columns. If `most` is 0 but gates with
// values are near, the size is the number of levels that these gates may fill, from the sweep below
// a gate to the sweep above it. Otherwise the size is 0.
[[nodiscard]] std::vector<std::uint16_t> column_sizes(const Grid& base, const SweepStack& stack,
                                                      const ColumnGeometry& geometry);

}  // namespace stormcellar::grid
