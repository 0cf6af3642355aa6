#include "grid/frame/sphere_frame.h"

#include <cmath>

#include "base/degree.h"

namespace stormcellar::grid {
SphereFrame::SphereFrame(double latitude_deg, double longitude_deg) noexcept
    : latitude_deg_(latitude_deg),
      longitude_deg_(longitude_deg),
      sine_(std::sin(latitude_deg * degree)),
      cosine_(std::cos(latitude_deg * degree)) {}

// The component to the north is sin(lat2 - lat1) + 2 sin(lat1) cos(lat2) sin^2(dlon / 2). The
// textbook's difference of two products would lose accuracy close to the site.
PolarPoint SphereFrame::to_polar(GeoPoint point) const noexcept {
    const double half_turn = 0.5 * degree * (point.longitude_deg - longitude_deg_);
    const double half_sine = std::sin(half_turn);
    const double half_cosine = std::cos(half_turn);
    const double there_sine = std::sin(point.latitude_deg * degree);
    const double there_cosine = std::cos(point.latitude_deg * degree);
    const double rise = std::sin((point.latitude_deg - latitude_deg_) * degree);
    const double east = 2 * there_cosine * half_sine * half_cosine;
    const double north = rise + 2 * sine_ * there_cosine * half_sine * half_sine;
    const double up = sine_ * there_sine +
                      cosine_ * there_cosine * (half_cosine * half_cosine - half_sine * half_sine);
    const double across = std::sqrt(east * east + north * north);
    return {SiteFrame::from_plane(east, north).azimuth_deg, radius_m * std::atan2(across, up)};
}

}  // namespace stormcellar::grid
