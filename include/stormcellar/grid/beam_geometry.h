// stormcellar/grid/beam_geometry.h -- where a gate is, and which gate sees a point.
//
// Units     Meters and degrees at every boundary; heights are above mean sea level. A range leads
//           to the CENTER of a gate, as in message 31.
// Model     A straight ray over a sphere of radius 4/3 * Gaussian earth radius. The altitude of the
//           antenna enters the root. The arc is measured along the sphere at sea level.
// Source    Doviak & Zrnic (1993) eqs 2.28b-c, rearranged so that nothing cancels.
// Threads   A BeamGeometry is immutable, so any thread may use it.
// Errors    None: NaN in, NaN out.
// Accuracy  Each line is enforced by tests/grid/beam_geometry_test.cpp.
//             height, arc  1e-9 m of the formula in 113-bit floats, for ranges of -1 to 470 km and
//                          elevations of -5 to 60 degrees
//             round trip   1e-9 m and 1e-12 degrees for ranges of 1 km and more
//             float        Do not narrow: the same formula in float errs by 0.1 m.
//             NOT covered  the model itself: the radius along the azimuth (7 m at 230 km, 28 m at
//                          460 km, 35 N) and refraction other than 4/3 (docs/geometry.md)
#pragma once

namespace stormcellar::grid {

// WGS84 (NGA.STND.0036): the semi-major axis and the flattening.
inline constexpr double wgs84_semi_major_m = 6378137.0;
inline constexpr double wgs84_flattening = 1 / 298.257223563;

// Returns sqrt(M N), the radius of the sphere that fits the ellipsoid best at a latitude.
[[nodiscard]] double gaussian_radius_m(double latitude_deg) noexcept;

// A point as the antenna sees it. A negative range is behind the antenna, on the same line.
struct AntennaPoint {
    double range_m = 0;
    double elevation_deg = 0;
};

// The same point in the vertical plane of its azimuth.
struct EarthPoint {
    double arc_m = 0;     // along the earth at sea level; negative for a negative range
    double height_m = 0;  // above mean sea level
};

class BeamGeometry {
  public:
    BeamGeometry(double site_latitude_deg, double antenna_altitude_m) noexcept;

    [[nodiscard]] EarthPoint forward(AntennaPoint gate) const noexcept;  // NaN in, NaN out
    // Returns the gate at a point, in closed form. The range is never negative; the antenna itself
    // has elevation 0.
    [[nodiscard]] AntennaPoint inverse(EarthPoint point) const noexcept;

    // Returns the range and the height at which a beam of this elevation passes over the arc, or
    // NaN if the beam never does: elevation + arc / radius must stay below 90 degrees.
    struct BeamPoint {
        double range_m = 0;
        double height_m = 0;
    };
    [[nodiscard]] BeamPoint over(double arc_m, double elevation_deg) const noexcept;

    // height_over() returns over().height_m within 1e-8 m. A caller with many arcs and elevations
    // computes the angle of each arc and of each elevation once, and passes these angles in pairs.
    struct Angle {
        double sine = 0, cosine = 1;
    };
    [[nodiscard]] static Angle elevation_angle(double elevation_deg) noexcept;
    [[nodiscard]] Angle half_arc_angle(double arc_m) const noexcept;
    [[nodiscard]] double height_over(Angle half_arc, Angle elevation) const noexcept;

    [[nodiscard]] double effective_radius_m() const noexcept { return radius_m_; }
    [[nodiscard]] double antenna_altitude_m() const noexcept { return altitude_m_; }

  private:
    double radius_m_;    // 4/3 of the Gaussian radius
    double altitude_m_;  // of the antenna above mean sea level
    double antenna_m_;   // from the center of the sphere: radius + altitude
};

}  // namespace stormcellar::grid
