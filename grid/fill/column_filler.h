// grid/fill/column_filler.h -- fills the cells of a grid from prepared sweeps, tile by tile.
//
// Threads   Pure. fill_grid() uses `threads` threads of its own. The result has the same bits for
//           any number of threads.
#pragma once

#include <span>

#include "grid/sweep/sweep_stack.h"
#include "stormcellar/grid/column_geometry.h"
#include "stormcellar/grid/grid.h"
#include "stormcellar/grid/method.h"
#include "stormcellar/grid/tile.h"

namespace stormcellar::grid {

// Writes the status and the value of every cell in the tiles that a sweep sees. All other cells
// keep their values. Pass tiles of the geometry, or parts of tiles. `grid` must have the spec of
// the geometry, arrays of that size, and the status not_seen in every cell of the tiles.
void fill_grid(const SweepStack& stack, const ColumnGeometry& geometry, std::span<const Tile> tiles,
               const Method& method, int threads, Grid& grid);

}  // namespace stormcellar::grid
