// retrieve/quality/sun_position.h -- the direction of the sun as a radar sees it.
//
// Source    The low-precision formulas of the Astronomical Almanac (page C5), and the refraction of
//           Saemundsson (1986).
// Accuracy  0.02 degrees from 1950 to 2050 (tests/retrieve/sun_position_test.cpp). Not covered: the
//           bending of the beam near the ground, which differs from the bending of light by up to
//           0.1 degrees, and by more under anomalous propagation.
// Units     Degrees; azimuths clockwise from north.
// Threads   A pure function.
#pragma once

#include "stormcellar/base/utc_time.h"

namespace stormcellar::retrieve {

struct SunPosition {
    double azimuth_deg = 0, elevation_deg = 0;
};
[[nodiscard]] SunPosition sun_position(UtcTime time, double latitude_deg, double longitude_deg);

}  // namespace stormcellar::retrieve
