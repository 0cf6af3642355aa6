// grid/fill/detail_filler.h -- fills in what is asked beside the values of a grid
// (stormcellar/grid/cell_details.h).
//
// A pass of its own over a grid whose cells are filled, so that a grid without details pays
// nothing. Threads: rows may be filled by different threads; the result has the same bits for any
// number.
#pragma once

#include <vector>

#include "grid/fill/column_filler.h"
#include "stormcellar/grid/beam_model.h"
#include "stormcellar/grid/gridder.h"

namespace stormcellar::grid {

struct DetailWork {
    const level2::Volume& volume;
    const std::vector<ChosenSweep>& chosen;  // as in the stack
    const SweepStack& stack;
    BeamModel beam;
    const ColumnGeometry& geometry;
    const GridderOptions& options;
};

// Makes grid.details, of options.details; the grid's status must be filled.
void fill_details(const DetailWork& work, Grid& grid);

}  // namespace stormcellar::grid
