// grid/place/site_extent.h -- checks the positions of sites, and finds the center and the extent of
// a grid that holds them.
//
// Threads   Pure functions.
#pragma once

#include <span>

#include "stormcellar/base/result.h"
#include "stormcellar/grid/grid.h"
#include "stormcellar/grid/projection.h"
#include "stormcellar/grid/site_frame.h"

namespace stormcellar::grid {

// Returns bad_argument if the site's latitude, longitude or altitude is impossible.
[[nodiscard]] Status check_on_earth(const SitePosition& site);

// Returns the middle of the box of latitudes and longitudes that holds the sites. The box goes the
// shorter way around the earth. There must be at least one site.
[[nodiscard]] GeoPoint middle_of(std::span<const SitePosition> sites);

// The distances from the center to the outermost sites, east-west and north-south, in the plane
// about the center. Both are 0 if there are no sites.
struct HalfExtent {
    double x_m = 0, y_m = 0;
};
[[nodiscard]] HalfExtent half_extent_of(std::span<const SitePosition> sites, GeoPoint center);

// A mosaic whose extent is not given reaches this far beyond its outermost sites.
inline constexpr double seen_beyond_sites_m = 230'000;

}  // namespace stormcellar::grid
