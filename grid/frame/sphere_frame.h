// grid/frame/sphere_frame.h -- great circles from one point of a sphere of 6371 km that keeps the
// latitudes of WGS84. SphereFrame is the cheap alternative to the exact SiteFrame.
//
// Units     Meters along the sphere; degrees; azimuths are clockwise from north, [0, 360).
// Accuracy  Against the same sphere in 113-bit floats (tests/grid/frame_ladder_test.cpp): 1e-7 m on
//           the sphere, also close to the site and up to the antipode. In the plane of azimuth and
//           arc, which stretches the surroundings of the antipode, 1e-7 m up to 19,000 km. Against
//           WGS84: sphere_error_bound_m() (stormcellar/grid/frame_ladder.h).
// Threads   A SphereFrame is immutable.
#pragma once

#include "stormcellar/grid/site_frame.h"

namespace stormcellar::grid {

class SphereFrame {
  public:
    static constexpr double radius_m = 6371000;

    SphereFrame(double latitude_deg, double longitude_deg) noexcept;

    [[nodiscard]] PolarPoint to_polar(GeoPoint point) const noexcept;

  private:
    double latitude_deg_, longitude_deg_;
    double sine_, cosine_;  // of the latitude
};

}  // namespace stormcellar::grid
