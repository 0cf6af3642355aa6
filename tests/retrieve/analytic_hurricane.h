// tests/retrieve/analytic_hurricane.h -- volumes with a hurricane whose wind is known everywhere.
#pragma once

#include "stormcellar/grid/site_frame.h"
#include "tests/retrieve/folded_volume.h"

namespace stormcellar::retrieve {

// A modified Rankine vortex: the tangential wind grows in proportion to the radius up to the radius
// of maximum wind, and falls with a power of the radius outside.
struct AnalyticHurricane {
    grid::PlanePoint center{60'000, 50'000};
    double maximum_mps = 55, radius_m = 25'000, decay = 0.6;
    double inflow_mps = 5;  // at the radius of maximum wind, in proportion to the tangential wind
    double east_mps = 0, north_mps = 0;  // mean wind
    // Wave 1 of the tangential wind: its amplitude is this share of the mean, and the wave is
    // greatest toward this azimuth from the center
    double wave1 = 0, wave1_azimuth_deg = 0;
    double rotation = 1;  // -1 for the southern hemisphere

    // Returns the tangential wind, averaged over a circle.
    [[nodiscard]] double tangential_mps(double radius_m) const;
    // Returns the component along the beam at a point of the plane about the radar.
    [[nodiscard]] double along_beam_mps(double x_m, double y_m) const;
};

// Returns one sweep of 0.5 degrees to 230 km, at 28 degrees north or south.
[[nodiscard]] FoldedVolume hurricane_volume(const AnalyticHurricane& hurricane, double nyquist_mps);

}  // namespace stormcellar::retrieve
