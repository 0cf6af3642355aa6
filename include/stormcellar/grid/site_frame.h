// stormcellar/grid/site_frame.h -- geodesics from one point of the WGS84 ellipsoid: azimuth and arc
// to any other point.
//
// Callers use heights above mean sea level as heights above the ellipsoid, which makes a difference
// of about 1 m at 230 km.
//
// Units     Meters along the ellipsoid; degrees; azimuths are clockwise from north, [0, 360).
// Source    Karney (2013), Algorithms for geodesics, through GeographicLib.
// Threads   A SiteFrame is immutable, so any thread may use it.
// Errors    None.
// Accuracy  15 nanometers (GeographicLib); round trip 1e-8 m within 500 km, enforced by
//           tests/grid/site_frame_test.cpp.
#pragma once

namespace stormcellar::grid {

struct GeoPoint {
    double latitude_deg = 0;
    double longitude_deg = 0;  // [-180, 180]
};

// A point as seen from the origin of the frame. The origin itself has azimuth 0.
struct PolarPoint {
    double azimuth_deg = 0;
    double arc_m = 0;
};

// A point of the azimuthal equidistant plane about the origin: arc times sine and cosine of the
// azimuth.
struct PlanePoint {
    double x_m = 0;  // east
    double y_m = 0;  // north
};

class SiteFrame {
  public:
    // The latitude must be within -90 to 90; both must be finite.
    SiteFrame(double latitude_deg, double longitude_deg) noexcept;

    [[nodiscard]] PolarPoint to_polar(GeoPoint point) const noexcept;
    [[nodiscard]] GeoPoint to_geo(PolarPoint point) const noexcept;

    // These convert between polar points and the azimuthal equidistant plane about the origin, in
    // closed form.
    [[nodiscard]] static PolarPoint from_plane(double x_m, double y_m) noexcept;
    [[nodiscard]] static PlanePoint to_plane(PolarPoint point) noexcept;

  private:
    double latitude_deg_;
    double longitude_deg_;
};

}  // namespace stormcellar::grid
