// grid/place/footprint.h -- the outline of a cell as the site sees it.
//
// A cell is treated as a parallelogram in the plane of azimuth and arc about the site. Its sides
// are half way to the neighboring columns. In a grid of one column or one row, one side has no
// neighbor; it is computed from the other side, or from the spacing of the spec.
//
// Accuracy  Within 460 km, for cells of 500 m to 10 km, the gaps and overlaps between the outlines
//           of neighboring cells are less than 0.1 % of a cell. In a latitude-longitude grid, rows
//           get shorter toward the poles, which adds the cell's height / 6371 km * tan(latitude)
//           (tests/grid/footprint_test.cpp).
// Threads   A pure function.
#pragma once

#include "stormcellar/grid/column_geometry.h"

namespace stormcellar::grid {

// The outline of a cell. "Along" is the direction at which the site sees the center of the cell;
// "across" is clockwise from there.
struct Footprint {
    float azimuth_deg = 0;
    float arc_m = 0;
    // For a point at `along` and `across` (meters) from the center, u = u_along * along + u_across
    // * across, and v likewise. The point is inside the cell if both are within +-1/2.
    float u_along = 0, u_across = 0;
    float v_along = 0, v_across = 0;
    float radius_m = 0;  // distance of the farthest corner from the center
};

[[nodiscard]] Footprint footprint_of(const ColumnGeometry& geometry, int ix, int iy);

}  // namespace stormcellar::grid
