// grid/fill/detail_filler.h -- computes the details of the cells of a grid
// (stormcellar/grid/cell_details.h).
//
// The details are computed in a separate pass, after the cells are filled. So a grid without
// details takes no longer.
//
// Threads   Pure. It uses `options.threads` threads of its own. The result has the same bits for
//           any number of threads.
#pragma once

#include <vector>

#include "grid/fill/column_filler.h"
#include "stormcellar/grid/beam_model.h"
#include "stormcellar/grid/gridder.h"

namespace stormcellar::grid {

struct DetailWork {
    const level2::Volume& volume;
    const std::vector<ChosenSweep>& chosen;  // the sweeps of the stack
    const SweepStack& stack;
    BeamModel beam;
    const ColumnGeometry& geometry;
    const GridderOptions& options;
};

// Fills grid.details with the details in options.details. The status of the grid must be filled
// before.
void fill_details(const DetailWork& work, Grid& grid);

}  // namespace stormcellar::grid
