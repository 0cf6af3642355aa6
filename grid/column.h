// grid/column.h -- the cells of one column from what each sweep holds there: the status rule.
//
// DESIGN section 5: a cell is a point sample with weights v (valued), n (no echo), f (folded) and u
// (not seen). u over one half: not seen; else f the largest: range folded; else v < n: no echo;
// else a value, into which no echo enters at its gate's detection limit for reflectivity and never
// for other moments. Folded and not seen never enter a value: the weights of the rest are scaled
// to 1. Moments that wrap (VEL, PHI) are never averaged: the sample with the larger weight stands.
#pragma once

#include <span>

#include "grid/polar_sweep.h"

namespace stormcellar::grid {

enum class Blending {
    with_detection_limit,  // REF
    values_only,           // SW, ZDR, RHO, CFP
    nearest,               // VEL, PHI
};
[[nodiscard]] Blending blending_of(level2::Moment moment);

struct CellResult {
    CellStatus status = CellStatus::not_seen;
    float value = 0;
};

// Of two samples, `weight_b` in [0, 1] being the second one's share.
[[nodiscard]] CellResult blend(const Sample& a, const Sample& b, float weight_b, Blending blending);

// What one sweep gives to a column. Heights rise, or stay equal, from each sweep to the next. The
// edges matter for the first and the last beam and beside a lost cut; elsewhere they are not read.
struct BeamSample {
    Sample sample;
    float height_m = 0;
    float lower_edge_m = 0;
    float upper_edge_m = 0;
    bool adjacent_to_next = true;
};

// Fills a column, at least one beam. Between the beams of adjacent sweeps cells are blended, linear
// in height. Outside (below the lowest, above the highest, between sweeps with a lost cut between
// them) a cell takes the sample of the nearer beam when it lies within its edges, else it is not
// seen. Only cells that hold a value get one written.
void fill_column(std::span<const BeamSample> beams, std::span<const float> levels_m,
                 Blending blending, std::span<CellStatus> status, std::span<float> values);

}  // namespace stormcellar::grid
