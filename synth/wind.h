// synth/wind.h -- defines an analytic wind: the horizontal motion of the air at any point and time,
// in closed form.
//
// The wind is the sum of a wind that depends only on height, and of any number of vortices.
//   levels   The wind is linear in height between levels, and constant below the lowest and above
//            the highest level. One level is a uniform wind, two are a linear shear, and more are a
//            hodograph. Without levels, this part is 0.
//   vortex   At the distance r from the center, the wind around the center is tangential f(r), and
//            the wind away from the center is radial f(r). f = r / radius up to the radius of the
//            greatest wind, and f = (radius / r)^decay beyond. Within the radius, the vorticity is
//            2 tangential / radius, and the divergence is 2 radial / radius. A decay of 1 is the
//            Rankine vortex, which has neither vorticity nor divergence beyond the radius.
//            Hurricanes have decays of 0.4 to 0.6. If tangential is 0, the vortex is a center of
//            divergence; if tangential and radial are not 0, the vortex is a hurricane with inflow.
//
// Units     As in synth/plane.h; time in seconds since the start of the scene.
// Source    The combined vortex of Rankine as in Donaldson (1970); decay as in Hughes (1952).
// Accuracy  The formulas in double: 1e-12 m/s at the points of tests/synth/wind_test.cpp. The wind
//           is continuous, except at the base and the top of a vortex and at levels of equal
//           height.
// Errors    None. A vortex without a positive radius is calm.
// Threads   Plain data and pure functions.
//
// Not covered: vertical motion, turbulence, and vortices that lean.
#pragma once

#include <limits>
#include <vector>

#include "synth/plane.h"

namespace stormcellar::synth {

struct WindLevel {
    double height_m = 0;
    Motion wind = {};
};

// An upright column of air around a center that drifts over the plane.
struct Vortex {
    double x_m = 0;  // the center at t = 0
    double y_m = 0;
    Motion motion = {};
    double radius_m = 1000;     // of the greatest wind
    double tangential_mps = 0;  // positive: counterclockwise
    double radial_mps = 0;      // positive: away from the center
    double decay = 1;
    double base_m = -std::numeric_limits<double>::infinity();  // calm below the base
    double top_m = std::numeric_limits<double>::infinity();    // and above the top
};

struct Wind {
    std::vector<WindLevel> levels = {};  // from the lowest up
    std::vector<Vortex> vortices = {};
};

[[nodiscard]] Motion wind_at(const Wind& wind, const Point& point, double t_s);

// Returns the component of a horizontal motion along a beam, positive away from the radar.
[[nodiscard]] double away_mps(const Motion& motion, double azimuth_deg, double elevation_deg);

// Returns the same wind in the plane about the radar at `stand`; see seen_from() in synth/truth.h.
[[nodiscard]] Wind seen_from(const Wind& wind, const Stand& stand);

}  // namespace stormcellar::synth
