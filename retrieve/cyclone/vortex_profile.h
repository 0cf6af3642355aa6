// retrieve/cyclone/vortex_profile.h -- fits circles of many radii about one center.
//
// Units     Meters in the plane about the site; m/s.
// Threads   Pure functions.
#pragma once

#include <vector>

#include "retrieve/cyclone/ring_fit.h"

namespace stormcellar::retrieve {

struct ProfileRing {
    double radius_m = 0;
    RingFit fit;
};

struct VortexProfile {
    static constexpr double step_m = 1000, least_radius_m = 3000, most_radius_m = 150'000;
    grid::PlanePoint center;
    std::vector<ProfileRing> rings;  // by radius, without gaps of more than 5 km

    // Returns the ring of the greatest tangential wind; there must be a ring.
    [[nodiscard]] const ProfileRing& strongest() const;
    // Returns the velocity along the beam of the fitted wind; NaN beyond the rings.
    [[nodiscard]] double velocity_at(double x_m, double y_m) const;
};

// Fits circles from `start_radius_m`, to the nearest kilometer, inward and outward, until the
// radar, the data or the largest radius ends them. Each circle takes its expected velocities from
// the circle before it, so that wrong fold numbers do not matter. `rings` is empty if the first
// circle cannot be fitted.
[[nodiscard]] VortexProfile fit_profile(const PolarVelocity& field, grid::PlanePoint center,
                                        double start_radius_m, double rotation);

}  // namespace stormcellar::retrieve
