// grid/fill/column.h -- fills the cells of one column from one sample of each sweep.
//
// Between the beams of two adjacent sweeps, a cell is blended from both, linear in height, or takes
// the nearer beam (Interpolation::nearest). Elsewhere (below the lowest beam, above the highest,
// and between sweeps with a lost cut between them), a cell takes the sample of the beam whose edges
// enclose it. If two beams enclose the cell, the nearer beam counts. If no beam encloses the cell,
// it is not seen. grid/sweep/mixture.h has the rule for blending two samples.
//
// Threads   Pure functions.
#pragma once

#include <span>

#include "grid/cells/level_table.h"
#include "grid/sweep/mixture.h"
#include "stormcellar/grid/method.h"

namespace stormcellar::grid {

// The contribution of one sweep to a column. In a column, the heights rise or stay equal from each
// sweep to the next. Only the first beam, the last beam and beams beside a lost cut need edges.
struct BeamSample {
    Sample sample;
    float height_m = 0;
    float lower_edge_m = 0;
    float upper_edge_m = 0;
    bool adjacent_to_next = true;
};

// Fills a column from at least one beam. `status` and `values` have one entry for each level. Every
// status must be not_seen before the call. A value is written only where the status becomes
// `value`.
void fill_column(std::span<const BeamSample> beams, const LevelTable& levels, Blending blending,
                 ChosenInterpolation interpolation, std::span<CellStatus> status,
                 std::span<float> values);
// Fills a column as the function above does. The template parameters say whether only the nearer
// beam counts and whether the moment wraps, so that the loops need not test it.
template <bool nearest, bool circular>
void fill_column_as(std::span<const BeamSample> beams, const LevelTable& levels, Blending blending,
                    std::span<CellStatus> status, std::span<float> values);

}  // namespace stormcellar::grid
