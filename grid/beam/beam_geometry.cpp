#include "stormcellar/grid/beam_geometry.h"

#include <cmath>
#include <limits>

#include "base/degree.h"

namespace stormcellar::grid {
namespace {

constexpr double refraction_factor = 4.0 / 3.0;

}  // namespace

// The radius is sqrt(M N) = a sqrt(1 - e^2) / (1 - e^2 sin^2 latitude), where a sqrt(1 - e^2) = a
// (1 - f).
double gaussian_radius_m(double latitude_deg) noexcept {
    const double sine = std::sin(latitude_deg * degree);
    const double eccentricity2 = wgs84_flattening * (2 - wgs84_flattening);
    return wgs84_semi_major_m * (1 - wgs84_flattening) / (1 - eccentricity2 * sine * sine);
}

BeamGeometry::BeamGeometry(double site_latitude_deg, double antenna_altitude_m) noexcept
    : radius_m_(refraction_factor * gaussian_radius_m(site_latitude_deg)),
      altitude_m_(antenna_altitude_m),
      antenna_m_(radius_m_ + antenna_altitude_m) {}

// The textbook height sqrt(r^2 + a^2 + 2 r a sin e) - a subtracts two lengths of 8,500 km, and so
// loses digits. With q = r^2 + 2 r a sin e, the height also equals q / (sqrt(a^2 + q) + a), where
// nothing cancels.
EarthPoint BeamGeometry::forward(AntennaPoint gate) const noexcept {
    const double elevation = gate.elevation_deg * degree;
    const double up_m = gate.range_m * std::sin(elevation);
    const double along_m = gate.range_m * std::cos(elevation);
    const double q = gate.range_m * gate.range_m + 2 * antenna_m_ * up_m;
    const double above_antenna_m = q / (std::sqrt(antenna_m_ * antenna_m_ + q) + antenna_m_);
    return {radius_m_ * std::atan2(along_m, antenna_m_ + up_m), altitude_m_ + above_antenna_m};
}

// From the antenna, the point is (a + h) sin t away and (a + h) cos t - a up. Here a is the radius
// of the earth, and t is the angle at its center. The second length also equals h - 2 (a + h)
// sin^2(t / 2), where nothing cancels.
AntennaPoint BeamGeometry::inverse(EarthPoint point) const noexcept {
    const double angle = point.arc_m / radius_m_;
    const double above_antenna_m = point.height_m - altitude_m_;
    const double point_m = antenna_m_ + above_antenna_m;
    const double half_sine = std::sin(angle / 2);
    const double along_m = point_m * std::sin(angle);
    const double up_m = above_antenna_m - 2 * point_m * half_sine * half_sine;
    return {std::hypot(along_m, up_m), std::atan2(up_m, along_m) / degree};
}

// The law of sines in the triangle of the earth's center, antenna and point gives range = a sin t /
// cos(e + t), and the height above the antenna = 2 a sin(e + t/2) sin(t/2) / cos(e + t).
BeamGeometry::BeamPoint BeamGeometry::over(double arc_m, double elevation_deg) const noexcept {
    const double elevation = elevation_deg * degree;
    const double angle = arc_m / radius_m_;
    const double cosine = std::cos(elevation + angle);
    if (!std::isgreater(cosine, 0.0)) {
        constexpr double nan = std::numeric_limits<double>::quiet_NaN();
        return {nan, nan};
    }
    const double above_antenna_m =
        2 * antenna_m_ * std::sin(elevation + angle / 2) * std::sin(angle / 2) / cosine;
    return {antenna_m_ * std::sin(angle) / cosine, altitude_m_ + above_antenna_m};
}

BeamGeometry::Angle BeamGeometry::elevation_angle(double elevation_deg) noexcept {
    const double elevation = elevation_deg * degree;
    return {std::sin(elevation), std::cos(elevation)};
}

BeamGeometry::Angle BeamGeometry::half_arc_angle(double arc_m) const noexcept {
    const double half = arc_m / radius_m_ / 2;
    return {std::sin(half), std::cos(half)};
}

double BeamGeometry::height_over(Angle half_arc, Angle elevation) const noexcept {
    const double arc_sine = 2 * half_arc.sine * half_arc.cosine;
    const double arc_cosine = 1 - 2 * half_arc.sine * half_arc.sine;
    const double cosine = elevation.cosine * arc_cosine - elevation.sine * arc_sine;
    if (!std::isgreater(cosine, 0.0)) return std::numeric_limits<double>::quiet_NaN();
    const double middle_sine = elevation.sine * half_arc.cosine + elevation.cosine * half_arc.sine;
    return altitude_m_ + 2 * antenna_m_ * middle_sine * half_arc.sine / cosine;
}

}  // namespace stormcellar::grid
