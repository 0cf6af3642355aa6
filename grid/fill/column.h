// grid/fill/column.h -- the cells of one column from one sample of each sweep.
//
// Between the beams of adjacent sweeps cells are blended, linear in height, or take the nearer beam
// (Interpolation::nearest). Outside (below the lowest, above the highest, between sweeps with a
// lost cut between them) a cell takes the sample of the nearer beam when it lies within its edges,
// else it is not seen. What mixed samples make is the rule of grid/sweep/mixture.h.
#pragma once

#include <span>

#include "grid/cells/level_table.h"
#include "grid/sweep/mixture.h"
#include "stormcellar/grid/method.h"

namespace stormcellar::grid {

// What one sweep gives to a column. Heights rise, or stay equal, from each sweep to the next. The
// edges matter for the first and the last beam and beside a lost cut; elsewhere they are not read.
struct BeamSample {
    Sample sample;
    float height_m = 0;
    float lower_edge_m = 0;
    float upper_edge_m = 0;
    bool adjacent_to_next = true;
};

// Fills a column, at least one beam; `status` and `values` have one place a level, and every status
// is not_seen yet. Only cells that hold a value get one written.
void fill_column(std::span<const BeamSample> beams, const LevelTable& levels, Blending blending,
                 ChosenInterpolation interpolation, std::span<CellStatus> status,
                 std::span<float> values);
// The same where it is known for all columns whether the nearer beam is taken and whether the
// moment wraps: what is not asked costs nothing.
template <bool nearest, bool circular>
void fill_column_as(std::span<const BeamSample> beams, const LevelTable& levels, Blending blending,
                    std::span<CellStatus> status, std::span<float> values);

}  // namespace stormcellar::grid
