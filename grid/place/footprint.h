// grid/place/footprint.h -- a cell's outline as the site sees it.
//
// The cell is taken as a parallelogram whose sides are half the way to the neighbouring columns, as
// they lie in the plane of azimuth and arc about the site (of a grid of one column or row: square,
// by the spec's spacing). Accuracy: outlines of neighbouring cells leave or share less than 0.1 %
// of a cell within 460 km, for cells of 500 m to 10 km; of a latitude-longitude grid, whose rows
// shorten towards the poles, the cell's height / 6371 km * tan(latitude) more
// (tests/grid/footprint_test.cpp).
// Threads: pure.
#pragma once

#include "stormcellar/grid/column_geometry.h"

namespace stormcellar::grid {

// In the directions along and across the azimuth (clockwise) in which the site sees the centre.
struct Footprint {
    float azimuth_deg = 0;
    float arc_m = 0;
    // u = u_along * along + u_across * across, and so for v: both within +-1/2 inside the cell.
    float u_along = 0, u_across = 0;
    float v_along = 0, v_across = 0;
    float radius_m = 0;  // no corner is farther from the centre
};

[[nodiscard]] Footprint footprint_of(const ColumnGeometry& geometry, int ix, int iy);

}  // namespace stormcellar::grid
