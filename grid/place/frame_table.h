// grid/place/frame_table.h -- azimuth and arc of a grid's columns from few exact geodesics.
//
// The grid is cut into blocks of at most 128 x 128 columns. In each, the columns' place in the
// azimuthal equidistant plane about the site (smooth wherever the site's antipode is far, the site
// itself included, which azimuth and arc are not) is a polynomial of degree 5 in both directions
// through exact geodesics at 6 x 6 Chebyshev nodes. It is compared with exact geodesics where its
// error peaks, the extremes of the nodes' own polynomial; a block that is off by more than half of
// frame_table_error_m is cut into four, and one of 128 columns or fewer is solved exactly. At worst
// that costs half as much again as solving each column; as a rule it solves one column in 200.
// Accuracy: frame_table_error_m of the exact place, before it is stored as floats; enforced by
//           tests/grid/frame_table_test.cpp for every column of grids of all projections, from pole
//           to pole, with cells of 10 m to 100 km.
// Threads:  a pure function.
#pragma once

#include <cstddef>
#include <functional>
#include <span>

#include "stormcellar/grid/grid_spec.h"
#include "stormcellar/grid/site_frame.h"

namespace stormcellar::grid {

inline constexpr double frame_table_error_m = 1e-3;

// Columns of row iy from first_ix on: where they lie in the plane about the site.
using TakePlaces = std::function<void(int iy, int first_ix, std::span<const PlanePoint> places)>;

// Gives every column of a valid spec once, in runs along the rows. Returns how many geodesics it
// solved.
std::size_t fill_by_table(const GridSpec& spec, const SiteFrame& site, const TakePlaces& take);

}  // namespace stormcellar::grid
