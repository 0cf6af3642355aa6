// grid/fill/column.h -- fills the cells of one column from one sample of each sweep.
//
// Between the beams of adjacent sweeps a cell is blended from both, linear in height, or takes the
// nearer beam (Interpolation::nearest). Anywhere else (below the lowest beam, above the highest,
// and between sweeps with a lost cut between them) a cell takes the sample of the nearer beam if it
// lies within the edges of that beam; if not, it is not seen. The rule of grid/sweep/mixture.h says
// what a blend of two samples is.
//
// Threads   Pure functions.
#pragma once

#include <span>

#include "grid/cells/level_table.h"
#include "grid/sweep/mixture.h"
#include "stormcellar/grid/method.h"

namespace stormcellar::grid {

// The contribution of one sweep to a column. Heights rise, or stay equal, from each sweep to the
// next. The edges are read only for the first and the last beam and beside a lost cut.
struct BeamSample {
    Sample sample;
    float height_m = 0;
    float lower_edge_m = 0;
    float upper_edge_m = 0;
    bool adjacent_to_next = true;
};

// Fills a column from at least one beam. `status` and `values` have one place for each level, and
// every status must be not_seen before. Only a cell that holds a value gets its value written.
void fill_column(std::span<const BeamSample> beams, const LevelTable& levels, Blending blending,
                 ChosenInterpolation interpolation, std::span<CellStatus> status,
                 std::span<float> values);
// Does the same for callers that know, for all columns, whether the nearer beam is taken and
// whether the moment wraps. The loops then do not test for either.
template <bool nearest, bool circular>
void fill_column_as(std::span<const BeamSample> beams, const LevelTable& levels, Blending blending,
                    std::span<CellStatus> status, std::span<float> values);

}  // namespace stormcellar::grid
