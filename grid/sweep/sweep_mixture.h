// grid/sweep/sweep_mixture.h -- mixes several gates of one sweep at a place of a column.
//
// Every mixture has weight 1, except that of gates_inside(). A place in a gap between radials, or
// beyond the gates, is not seen.
//
// Threads   Pure functions.
#pragma once

#include "grid/place/footprint.h"
#include "grid/sweep/polar_sweep.h"

namespace stormcellar::grid {

// Returns a mixture of the nearest gate alone.
[[nodiscard]] Mixture nearest_gate(const PolarSweep& sweep, float azimuth_deg, ArcPlace place);

// Mixes two gates of each of the two radials around the azimuth, with weights linear in azimuth and
// range.
[[nodiscard]] Mixture four_gates(const PolarSweep& sweep, float azimuth_deg, ArcPlace place);

// Mixes all radials within reach, weighted by the antenna's pattern in azimuth
// (grid/beam/beam_pattern.h). Two gates of each radial count, with weights linear in range.
[[nodiscard]] Mixture gates_by_pattern(const PolarSweep& sweep, float azimuth_deg, ArcPlace place,
                                       float beam_width_deg);

// Mixes all gates whose centers are in the outline, with equal weights. Parts of the outline beyond
// the last gate or in azimuth gaps count as not seen. If no gate's center is inside, the weight is
// 0.
//
// Accuracy: gates are placed over a plane through the center of the cell. For outlines up to 20 km,
// within 470 km and below 21 km, their places are off by 2.5 m at elevations of -5 to 0.5 degrees,
// 3 m up to 1.5, 4 m up to 5, 10 m up to 19.5 and 90 m up to 60
// (tests/grid/sweep_mixture_test.cpp).
[[nodiscard]] Mixture gates_inside(const PolarSweep& sweep, const Footprint& footprint,
                                   ArcPlace place);

}  // namespace stormcellar::grid
