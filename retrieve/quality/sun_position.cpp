#include "retrieve/quality/sun_position.h"

#include <chrono>
#include <cmath>
#include <numbers>

namespace stormcellar::retrieve {
namespace {

constexpr double radian = std::numbers::pi / 180;

// Returns how much the air lifts a body at an elevation.
double refraction_deg(double elevation_deg) {
    if (elevation_deg < -1) return 0;
    return 1.02 / 60 / std::tan((elevation_deg + 10.3 / (elevation_deg + 5.11)) * radian);
}

}  // namespace

SunPosition sun_position(UtcTime time, double latitude_deg, double longitude_deg) {
    using namespace std::chrono;
    constexpr UtcTime epoch = sys_days{year{2000} / 1 / 1} + hours{12};
    const double days = duration<double, days::period>(time - epoch).count();
    const double mean_longitude_deg = 280.460 + 0.9856474 * days;
    const double anomaly = (357.528 + 0.9856003 * days) * radian;
    const double longitude =
        (mean_longitude_deg + 1.915 * std::sin(anomaly) + 0.020 * std::sin(2 * anomaly)) * radian;
    const double tilt = (23.439 - 0.0000004 * days) * radian;
    const double ascension = std::atan2(std::cos(tilt) * std::sin(longitude), std::cos(longitude));
    const double declination = std::asin(std::sin(tilt) * std::sin(longitude));
    const double sidereal = (280.46061837 + 360.98564736629 * days + longitude_deg) * radian;
    const double hour_angle = sidereal - ascension;
    const double latitude = latitude_deg * radian;
    const double elevation =
        std::asin(std::sin(latitude) * std::sin(declination) +
                  std::cos(latitude) * std::cos(declination) * std::cos(hour_angle)) /
        radian;
    const double azimuth =
        std::atan2(-std::cos(declination) * std::sin(hour_angle),
                   std::sin(declination) * std::cos(latitude) -
                       std::cos(declination) * std::sin(latitude) * std::cos(hour_angle)) /
        radian;
    return {azimuth < 0 ? azimuth + 360 : azimuth, elevation + refraction_deg(elevation)};
}

}  // namespace stormcellar::retrieve
