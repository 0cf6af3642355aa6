// grid/fill/beam_mixture.h -- one sweep over one column as a mixture of gates, by any method.
//
// Threads: pure functions.
#pragma once

#include "grid/place/footprint.h"
#include "grid/sweep/polar_sweep.h"
#include "stormcellar/grid/method.h"

namespace stormcellar::grid {

// What one sweep gives to a column. Heights rise, or stay equal, from each sweep of a column to the
// next.
struct BeamMixture {
    Mixture mixture;
    float height_m = 0;
    float lower_edge_m = 0;
    float upper_edge_m = 0;
    float rise_m_per_deg = 0;
    bool adjacent_to_next = true;
};

// The gates of the sweep that the method takes at an azimuth and arc. `footprint` is that of a cell
// with an extent, null of a point; a cell that holds no gate's center is taken as a point.
[[nodiscard]] Mixture mixture_over(const PolarSweep& sweep, const Method& method,
                                   float beam_width_deg, float azimuth_deg, ArcPlace place,
                                   const Footprint* footprint);

// Where the beam passes over an azimuth and arc, by the elevation of its nearest radial where the
// method says so; its mixture is empty.
[[nodiscard]] BeamMixture beam_over(const PolarSweep& sweep, const Method& method,
                                    float azimuth_deg, ArcPlace place);

}  // namespace stormcellar::grid
