#include "synth/wind.h"

#include <algorithm>
#include <cmath>

namespace stormcellar::synth {
namespace {

Motion wind_of_levels(const std::vector<WindLevel>& levels, double z_m) {
    if (levels.empty()) return {};
    const auto above = std::upper_bound(
        levels.begin(), levels.end(), z_m,
        [](double height_m, const WindLevel& level) { return height_m < level.height_m; });
    if (above == levels.begin()) return levels.front().wind;
    if (above == levels.end()) return levels.back().wind;
    const WindLevel& below = *(above - 1);
    const double part = (z_m - below.height_m) / (above->height_m - below.height_m);
    return {below.wind.east_mps + part * (above->wind.east_mps - below.wind.east_mps),
            below.wind.north_mps + part * (above->wind.north_mps - below.wind.north_mps)};
}

Motion wind_of(const Vortex& vortex, const Point& point, double t_s) {
    if (!(vortex.radius_m > 0) || point.z_m < vortex.base_m || point.z_m > vortex.top_m) return {};
    const double east_m = point.x_m - vortex.x_m - vortex.motion.east_mps * t_s;
    const double north_m = point.y_m - vortex.y_m - vortex.motion.north_mps * t_s;
    const double distance_m = std::hypot(east_m, north_m);
    // Compute f(r) / r, which has no singularity at the center.
    double per_m = 1 / vortex.radius_m;
    if (distance_m > vortex.radius_m) {
        const double near = vortex.radius_m / distance_m;
        per_m = (vortex.decay == 1 ? near : std::pow(near, vortex.decay)) / distance_m;
    }
    return {per_m * (vortex.radial_mps * east_m - vortex.tangential_mps * north_m),
            per_m * (vortex.radial_mps * north_m + vortex.tangential_mps * east_m)};
}

}  // namespace

Motion wind_at(const Wind& wind, const Point& point, double t_s) {
    Motion sum = wind_of_levels(wind.levels, point.z_m);
    for (const Vortex& vortex : wind.vortices) {
        const Motion own = wind_of(vortex, point, t_s);
        sum.east_mps += own.east_mps;
        sum.north_mps += own.north_mps;
    }
    return sum;
}

double away_mps(const Motion& motion, double azimuth_deg, double elevation_deg) {
    return (motion.east_mps * std::sin(azimuth_deg * degree) +
            motion.north_mps * std::cos(azimuth_deg * degree)) *
           std::cos(elevation_deg * degree);
}

Wind seen_from(const Wind& wind, const Stand& stand) {
    Wind there = wind;
    for (WindLevel& level : there.levels)
        level.wind = motion_from(stand, level.wind);
    for (Vortex& vortex : there.vortices) {
        const Offset center = place_from(stand, vortex.x_m, vortex.y_m);
        vortex.x_m = center.east_m;
        vortex.y_m = center.north_m;
        vortex.motion = motion_from(stand, vortex.motion);
    }
    return there;
}

}  // namespace stormcellar::synth
