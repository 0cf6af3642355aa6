#include "grid/place/site_extent.h"

#include <algorithm>
#include <cmath>

#include "base/floating_point.h"

namespace stormcellar::grid {

Status check_on_earth(const SitePosition& site) {
    const bool on_earth = is_within(site.latitude_deg, -90.0, 90.0) &&
                          is_within(site.longitude_deg, -360.0, 360.0) &&
                          is_within(site.altitude_m, -10000.0, 10000.0);
    if (on_earth) return {};
    return fail(ErrorCode::bad_argument, "the site {} at {}, {}, {} m is not on the earth",
                site.icao, site.latitude_deg, site.longitude_deg, site.altitude_m);
}

GeoPoint middle_of(std::span<const SitePosition> sites) {
    const double base_deg = sites.front().longitude_deg;
    double south = 90, north = -90, west = 360, east = -360;
    for (const SitePosition& site : sites) {
        const double off_deg = std::remainder(site.longitude_deg - base_deg, 360.0);
        south = std::min(south, site.latitude_deg);
        north = std::max(north, site.latitude_deg);
        west = std::min(west, off_deg);
        east = std::max(east, off_deg);
    }
    return {(south + north) / 2, std::remainder(base_deg + (west + east) / 2, 360.0)};
}

HalfExtent half_extent_of(std::span<const SitePosition> sites, GeoPoint center) {
    const SiteFrame frame(center.latitude_deg, center.longitude_deg);
    HalfExtent half;
    for (const SitePosition& site : sites) {
        const auto place =
            SiteFrame::to_plane(frame.to_polar({site.latitude_deg, site.longitude_deg}));
        half.x_m = std::max(half.x_m, std::abs(place.x_m));
        half.y_m = std::max(half.y_m, std::abs(place.y_m));
    }
    return half;
}

}  // namespace stormcellar::grid
