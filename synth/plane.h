// synth/plane.h -- defines points, offsets and motions in the plane of a scene.
//
// Units     Meters, m/s, degrees. x points east and y north of the origin of the scene (the radar),
//           in the azimuthal equidistant plane about it. z is the height above mean sea level.
//           Angles are clockwise from north.
// Threads   Plain data and a pure function.
#pragma once

#include <cmath>

#include "base/degree.h"

namespace stormcellar::synth {

struct Point {
    double x_m = 0;
    double y_m = 0;
    double z_m = 0;
};

struct Offset {
    double east_m = 0;
    double north_m = 0;
};

struct Motion {
    double east_mps = 0;
    double north_mps = 0;
};

// The place of another radar in the plane. Because meridians converge, its north is turned by an
// angle, clockwise from the plane's y.
struct Stand {
    double x_m = 0;
    double y_m = 0;
    double turn_deg = 0;
};

// Turns an offset clockwise.
[[nodiscard]] inline Offset turned(const Offset& offset, double turn_deg) {
    const double sine = std::sin(turn_deg * degree);
    const double cosine = std::cos(turn_deg * degree);
    return {offset.east_m * cosine + offset.north_m * sine,
            offset.north_m * cosine - offset.east_m * sine};
}

// Return the same place, or the same motion, in the plane of the radar at `stand`.
[[nodiscard]] inline Offset place_from(const Stand& stand, double x_m, double y_m) {
    return turned({x_m - stand.x_m, y_m - stand.y_m}, -stand.turn_deg);
}
[[nodiscard]] inline Motion motion_from(const Stand& stand, const Motion& motion) {
    const Offset turn = turned({motion.east_mps, motion.north_mps}, -stand.turn_deg);
    return {turn.east_m, turn.north_m};
}

}  // namespace stormcellar::synth
