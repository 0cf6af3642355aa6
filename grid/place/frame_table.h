// grid/place/frame_table.h -- computes azimuth and arc of a grid's columns from only a few exact
// geodesics.
//
// The grid is cut into blocks of at most 128 x 128 columns. In each block, the place of a column in
// the azimuthal equidistant plane about the site is a polynomial of degree 5 in both directions.
// The polynomial goes through exact geodesics at 6 x 6 Chebyshev nodes. The plane is smooth
// wherever the site's antipode is far, even at the site itself, where azimuth and arc are not
// smooth.
//
// The polynomial is compared with exact geodesics where its error is largest: at the peaks of the
// Chebyshev polynomial whose zeros are the nodes. If the error exceeds half of frame_table_error_m,
// the block is cut into four, or solved exactly if it has 128 columns or fewer. The worst case
// costs one and a half times as much as solving each column. Usually one column in 200 is solved.
//
// Accuracy  frame_table_error_m from the exact place, before the place is stored as floats.
//           Enforced by tests/grid/frame_table_test.cpp for every column of grids of all
//           projections, from pole to pole, with cells of 10 m to 100 km.
// Threads   A pure function.
#pragma once

#include <cstddef>
#include <functional>
#include <span>

#include "stormcellar/grid/grid_spec.h"
#include "stormcellar/grid/site_frame.h"

namespace stormcellar::grid {

inline constexpr double frame_table_error_m = 1e-3;

// Receives the places, in the plane about the site, of the columns of row iy from first_ix on.
using TakePlaces = std::function<void(int iy, int first_ix, std::span<const PlanePoint> places)>;

// Calls `take` with the columns of a valid spec, in runs along the rows. Each column is in one run.
// Returns how many geodesics were solved.
std::size_t fill_by_table(const GridSpec& spec, const SiteFrame& site, const TakePlaces& take);

}  // namespace stormcellar::grid
