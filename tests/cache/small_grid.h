// tests/cache/small_grid.h -- a grid with every kind of brick, small enough to damage byte by byte.
#pragma once

#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/grid/grid.h"

namespace stormcellar::testing {

// 40 x 24 x 18 cells, which are 3 x 2 x 2 bricks. Cells are values, folded, no echo and not seen.
// Some bricks are uniform, some have states alone, some are stored.
[[nodiscard]] grid::Grid small_grid();

}  // namespace stormcellar::testing
