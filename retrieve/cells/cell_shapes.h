// retrieve/cells/cell_shapes.h -- the place, size and columns of each group of a flooded echo.
//
// Units     As in stormcellar/retrieve/storm_cells.h.
// Threads   A pure function.
#pragma once

#include <vector>

#include "retrieve/cells/peak_flood.h"
#include "stormcellar/retrieve/storm_cells.h"

namespace stormcellar::retrieve {

// Describes the groups that fulfill the options, the strongest first. Sets position, area, maximum
// and columns.
[[nodiscard]] std::vector<StormCell> shape_cells(const grid::BrickView& view,
                                                 const StrongEcho& echo, const FloodedEcho& flooded,
                                                 const CellOptions& options);

}  // namespace stormcellar::retrieve
