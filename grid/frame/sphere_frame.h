// grid/frame/sphere_frame.h -- computes great circles from one point. The earth is a sphere of 6371
// km, on which a place has the latitude that it has in WGS84. This is the cheap alternative to the
// exact SiteFrame.
//
// Units     Meters along the sphere; degrees; azimuths are clockwise from north, [0, 360).
// Accuracy  Against the same sphere in 113-bit floats (tests/grid/frame_ladder_test.cpp): 1e-7 m on
//           the sphere, also close to the site and up to the antipode. In the plane of azimuth and
//           arc, 1e-7 m up to 19,000 km; beyond, the plane stretches the surroundings of the
//           antipode. Against WGS84: sphere_error_bound_m() (stormcellar/grid/frame_ladder.h).
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
