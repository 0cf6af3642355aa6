// grid/place/site_extent.h -- where sites stand, and a grid's place from the sites that it shall
// hold.
//
// Thread contract: pure functions.
#pragma once

#include <span>

#include "stormcellar/base/result.h"
#include "stormcellar/grid/grid.h"
#include "stormcellar/grid/projection.h"
#include "stormcellar/grid/site_frame.h"

namespace stormcellar::grid {

// bad_argument unless the site has a latitude, a longitude and an altitude that the earth has.
[[nodiscard]] Status check_on_earth(const SitePosition& site);

// The middle of the box of latitudes and longitudes that holds the sites, by the shorter way round
// the earth. There must be one site at least.
[[nodiscard]] GeoPoint middle_of(std::span<const SitePosition> sites);

// How far the outermost sites lie from the center, east or west and north or south, in the plane
// about it; 0 of no site.
struct HalfExtent {
    double x_m = 0, y_m = 0;
};
[[nodiscard]] HalfExtent half_extent_of(std::span<const SitePosition> sites, GeoPoint center);

}  // namespace stormcellar::grid
