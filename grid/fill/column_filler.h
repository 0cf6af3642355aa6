// grid/fill/column_filler.h -- fills the cells of a grid tile by tile from prepared sweeps.
//
// Threads: tiles may be filled by different threads; the result has the same bits for any number.
#pragma once

#include <span>

#include "grid/sweep/sweep_stack.h"
#include "stormcellar/grid/column_geometry.h"
#include "stormcellar/grid/grid.h"
#include "stormcellar/grid/method.h"
#include "stormcellar/grid/tile.h"

namespace stormcellar::grid {

// Writes status and values of every cell of the tiles that a sweep sees; the others stay as they
// are. The tiles are those of the geometry, or others within it. `grid` must have the geometry's
// spec and arrays of its size, every status of the tiles' cells not_seen.
void fill_grid(const SweepStack& stack, const ColumnGeometry& geometry, std::span<const Tile> tiles,
               const Method& method, int threads, Grid& grid);

}  // namespace stormcellar::grid
