// grid/fill/detail_filler.h -- fills in the details of the cells of a grid
// (stormcellar/grid/cell_details.h).
//
// It is a separate pass over a grid whose cells are filled, so a grid without details costs nothing
// extra.
//
// Threads   Pure; it uses `options.threads` threads of its own. The result has the same bits for
//           any number of threads.
#pragma once

#include <vector>

#include "grid/fill/column_filler.h"
#include "stormcellar/grid/beam_model.h"
#include "stormcellar/grid/gridder.h"

namespace stormcellar::grid {

struct DetailWork {
    const level2::Volume& volume;
    const std::vector<ChosenSweep>& chosen;  // the same as in the stack
    const SweepStack& stack;
    BeamModel beam;
    const ColumnGeometry& geometry;
    const GridderOptions& options;
};

// Makes grid.details with the set options.details. The status of the grid must be filled.
void fill_details(const DetailWork& work, Grid& grid);

}  // namespace stormcellar::grid
