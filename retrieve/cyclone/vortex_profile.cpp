#include "retrieve/cyclone/vortex_profile.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stormcellar::retrieve {
namespace {

constexpr double widest_gap_m = 5000;

// Adds the circles on one side of the last ring.
void extend(const PolarVelocity& field, RingRequest request, double step_m,
            std::vector<ProfileRing>& rings) {
    RingSeries expected = rings.back().fit.series;
    double last_m = rings.back().radius_m;
    request.expected = &expected;
    for (request.radius_m += step_m; request.radius_m >= VortexProfile::least_radius_m &&
                                     request.radius_m <= VortexProfile::most_radius_m &&
                                     std::abs(request.radius_m - last_m) <= widest_gap_m;
         request.radius_m += step_m) {
        const auto fit = fit_ring(field, request);
        if (!fit) continue;
        rings.push_back({request.radius_m, *fit});
        expected = fit->series;
        last_m = request.radius_m;
    }
}

}  // namespace

const ProfileRing& VortexProfile::strongest() const {
    return *std::ranges::max_element(
        rings, {}, [](const ProfileRing& ring) { return ring.fit.tangential_mps; });
}

double VortexProfile::velocity_at(double x_m, double y_m) const {
    const double x = x_m - center.x_m, y = y_m - center.y_m, radius = std::hypot(x, y);
    if (rings.empty() || radius < rings.front().radius_m || radius > rings.back().radius_m)
        return std::numeric_limits<double>::quiet_NaN();
    const auto nearest =
        std::ranges::lower_bound(rings, radius - step_m / 2, {}, &ProfileRing::radius_m);
    const double distance = std::hypot(center.x_m, center.y_m);
    const double east = center.x_m / distance, north = center.y_m / distance;
    return series_at(nearest->fit.series, (x * east + y * north) / radius,
                     (y * east - x * north) / radius) *
           distance / std::hypot(x_m, y_m);
}

VortexProfile fit_profile(const PolarVelocity& field, grid::PlanePoint center,
                          double start_radius_m, double rotation) {
    VortexProfile profile;
    profile.center = center;
    RingRequest request;
    request.center = center;
    request.radius_m = VortexProfile::step_m * std::round(start_radius_m / VortexProfile::step_m);
    request.rotation = rotation;
    const auto first = fit_ring(field, request);
    if (!first) return profile;
    profile.rings.push_back({request.radius_m, *first});
    extend(field, request, -VortexProfile::step_m, profile.rings);
    std::ranges::reverse(profile.rings);
    extend(field, request, VortexProfile::step_m, profile.rings);
    return profile;
}

}  // namespace stormcellar::retrieve
