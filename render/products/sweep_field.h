// render/products/sweep_field.h -- shows a sweep as the radar saw it, seen from above on the plane
// of a grid spec.
//
// Each place shows one gate (stormcellar/grid/sweep_lookup.h): values are not mixed.
//
// Accuracy  Places are exact on a plane about the radar itself. On another plane, azimuth and arc
//           are computed every few pixels and interpolated linearly, within 0.5 m for radars up to
//           500 km from the middle of the picture (tests/render/sweep_field_test.cpp).
// Threads   Pure functions; the same bits for any number of threads.
#pragma once

#include "render/products/flat_field.h"
#include "stormcellar/grid/grid_spec.h"
#include "stormcellar/grid/sweep_lookup.h"
#include "stormcellar/render/view_geometry.h"

namespace stormcellar::render {

// Returns the gate at the middle of each pixel of a map, rows from the top down. Outside the grid,
// pixels are not seen.
[[nodiscard]] FlatField sweep_in_picture(const grid::SweepLookup& sweep, const grid::GridSpec& spec,
                                         const ViewGeometry& geometry, int threads);

// Returns the gate at the center of each column, rows from south to north.
[[nodiscard]] FlatField sweep_in_columns(const grid::SweepLookup& sweep, const grid::GridSpec& spec,
                                         int threads);

}  // namespace stormcellar::render
