// grid/sweep/sweep_mixture.h -- several gates of one sweep, as a column sees them.
//
// Every mixture has weight 1. What lies in a gap or beyond the gates is not seen.
#pragma once

#include "grid/place/footprint.h"
#include "grid/sweep/polar_sweep.h"

namespace stormcellar::grid {

// The nearest gate alone.
[[nodiscard]] Mixture nearest_gate(const PolarSweep& sweep, float azimuth_deg, ArcPlace place);

// Two gates of the two radials around the azimuth, linear in azimuth and range.
[[nodiscard]] Mixture four_gates(const PolarSweep& sweep, float azimuth_deg, ArcPlace place);

// Every radial within reach by the antenna's pattern in azimuth (grid/beam/beam_pattern.h), linear
// in range between two gates of each.
[[nodiscard]] Mixture gates_by_pattern(const PolarSweep& sweep, float azimuth_deg, ArcPlace place,
                                       float beam_width_deg);

// All gates whose centres lie in the outline, each with the same weight; gates beyond the last one
// and the share of the outline in azimuth gaps are not seen. Weight 0 where no gate's centre is
// inside. Gates stand over a plane through the cell's centre: for outlines up to 20 km, within 470
// km and as far as beams lie below 21 km, off by 2.5 m at elevations of -5 to 0.5 degrees, 3 m up
// to 1.5, 4 m up to 5, 10 m up to 19.5 and 90 m up to 60 (tests/grid/sweep_mixture_test.cpp).
[[nodiscard]] Mixture gates_inside(const PolarSweep& sweep, const Footprint& footprint,
                                   ArcPlace place);

}  // namespace stormcellar::grid
