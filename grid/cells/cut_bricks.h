// grid/cells/cut_bricks.h -- cuts a window out of a quantized grid. The window is a grid of its
// own.
//
// Threads   Pure function.
// Errors    None. The window must be within the grid and hold whole bricks (is_whole_bricks()).
// Accuracy  Every cell keeps its state and its code.
#pragma once

#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/grid/grid_window.h"

namespace stormcellar::grid {

[[nodiscard]] BrickGrid cut_bricks(const BrickView& view, const GridWindow& window);

}  // namespace stormcellar::grid
