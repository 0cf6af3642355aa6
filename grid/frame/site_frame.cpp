#include "stormcellar/grid/site_frame.h"

#include <cmath>
#include <numbers>

#include <GeographicLib/Geodesic.hpp>
#include <GeographicLib/Math.hpp>

#include "base/floating_point.h"

namespace stormcellar::grid {
namespace {

// Returns the azimuth in [0, 360). A tiny negative azimuth plus 360 would round to 360, so it
// becomes 0.
double wrap_azimuth(double azimuth_deg) {
    const double wrapped = std::isless(azimuth_deg, 0.0) ? azimuth_deg + 360 : azimuth_deg;
    return std::isgreaterequal(wrapped, 360.0) ? 0 : wrapped;
}

}  // namespace

SiteFrame::SiteFrame(double latitude_deg, double longitude_deg) noexcept
    : latitude_deg_(latitude_deg), longitude_deg_(longitude_deg) {}

PolarPoint SiteFrame::to_polar(GeoPoint point) const noexcept {
    const MaskedTraps masked;
    double arc_m = 0;
    double azimuth_deg = 0;
    double azimuth_there_deg = 0;
    GeographicLib::Geodesic::WGS84().Inverse(latitude_deg_, longitude_deg_, point.latitude_deg,
                                             point.longitude_deg, arc_m, azimuth_deg,
                                             azimuth_there_deg);
    if (arc_m == 0) return {};
    return {wrap_azimuth(azimuth_deg), arc_m};
}

GeoPoint SiteFrame::to_geo(PolarPoint point) const noexcept {
    const MaskedTraps masked;
    GeoPoint there;
    GeographicLib::Geodesic::WGS84().Direct(latitude_deg_, longitude_deg_, point.azimuth_deg,
                                            point.arc_m, there.latitude_deg, there.longitude_deg);
    return there;
}

PolarPoint SiteFrame::from_plane(double x_m, double y_m) noexcept {
    constexpr double degrees_per_radian = 180 / std::numbers::pi;
    return {wrap_azimuth(std::atan2(x_m, y_m) * degrees_per_radian), std::hypot(x_m, y_m)};
}

PlanePoint SiteFrame::to_plane(PolarPoint point) noexcept {
    double sine = 0;
    double cosine = 0;
    GeographicLib::Math::sincosd(point.azimuth_deg, sine, cosine);
    return {point.arc_m * sine, point.arc_m * cosine};
}

}  // namespace stormcellar::grid
