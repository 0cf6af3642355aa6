// grid/fill/beam_mixture.h -- mixes the gates of one sweep over one column, for any method of
// gridding.
//
// Units     Meters above mean sea level for heights, degrees for angles.
// Threads   Pure functions.
#pragma once

#include "grid/place/footprint.h"
#include "grid/sweep/polar_sweep.h"
#include "stormcellar/grid/method.h"

namespace stormcellar::grid {

// The contribution of one sweep to a column. In a column, the heights rise or stay equal from each
// sweep to the next.
struct BeamMixture {
    Mixture mixture;
    float height_m = 0;
    float lower_edge_m = 0;
    float upper_edge_m = 0;
    float rise_m_per_deg = 0;
    bool adjacent_to_next = true;
};

// Returns the mixture of the sweep's gates at an azimuth and arc. `footprint` is the outline of a
// cell with an extent, or null for a point. A cell whose outline holds the center of no gate is
// treated as a point.
[[nodiscard]] Mixture mixture_over(const PolarSweep& sweep, const Method& method,
                                   float beam_width_deg, float azimuth_deg, ArcPlace place,
                                   const Footprint* footprint);

// Returns the heights of the beam over an azimuth and arc, with an empty mixture. The elevation of
// the beam is that of the nearest radial if the method uses measured elevations, else that of the
// sweep.
[[nodiscard]] BeamMixture beam_over(const PolarSweep& sweep, const Method& method,
                                    float azimuth_deg, ArcPlace place);

}  // namespace stormcellar::grid
