// stormcellar/retrieve/shear_peaks.h -- the strongest cyclonic azimuthal shear in layers of a grid.
//
// Method    For each column, the largest shear of the levels within the layer, both bounds
//           included. A peak is a column of at least `least_per_s` that has no larger column within
//           `separation_m`. Equal columns count in the order of rows, then columns.
// Units     s^-1, meters. Levels and heights are above mean sea level. The grid has the units of
//           AZSH (0.001 s^-1).
// Accuracy  A shear is exact to half a step of the grid's codes, and a place is the center of its
//           column (tests/retrieve/shear_peaks_test.cpp). Distances are on the plane of the grid.
// Not covered  The error of the shear itself, which grids do not hold. Ground clutter and wrong
//           fold numbers also make peaks (velocity_shear.h).
// Threads   Pure functions.
#pragma once

#include <cstddef>
#include <vector>

#include "stormcellar/grid/brick_view.h"
#include "stormcellar/grid/projection.h"

namespace stormcellar::retrieve {

struct ShearPeak {
    grid::GeoPoint position;
    int ix = 0, iy = 0;
    float azimuthal_per_s = 0;
    double height_m = 0;  // of the cell with this shear
};

struct ShearPeakOptions {
    double bottom_m = 0, top_m = 3000;
    float least_per_s = 0.006F;
    double separation_m = 5000;
    std::size_t most = 20;
};

// Returns the peaks, the strongest first. An empty layer and a grid without values have none.
[[nodiscard]] std::vector<ShearPeak> shear_peaks(const grid::BrickView& shear,
                                                 const ShearPeakOptions& options = {});

}  // namespace stormcellar::retrieve
