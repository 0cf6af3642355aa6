// render/products/rotation.h -- columns of rotation in a grid of azimuthal shear (AZSH).
//
// A column is a set of connected cells (each cell has 26 neighbors). Their shear is at least
// least_rotation in one sense of rotation, and the lowest and the highest level of the set are at
// least least_column_m apart. So cells of noise alone make no column. For each cell near a column,
// the result has the share of the cell's neighborhood that belongs to columns, weighted 1-2-1 along
// each axis. The share is above 0 if the rotation is counterclockwise, and below 0 if it is
// clockwise. All other cells are not seen. The surface at column_share is the column, rounded only
// to look better.
//
// Units     Shear in 0.001/s, as AZSH.
// Accuracy  Shares are exact to half a step of 0.01 (tests/render/rotation_test.cpp). The limit of
//           0.008/s leaves the mesocyclone of Moore on 3 May 1999 as one column.
// Limits    Shear of air that does not rotate looks the same to one radar, as along a gust front.
//           Far from the radar, beams are too wide to see the shear of small vortices.
// Threads   Pure.
#pragma once

#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/render/color_table.h"

namespace stormcellar::render {

inline constexpr float least_rotation = 8;
inline constexpr double least_column_m = 2000;
inline constexpr float column_share = 0.22F;

inline constexpr Rgba8 cyclonic_color = {140, 122, 255, 255};
inline constexpr Rgba8 anticyclonic_color = {214, 240, 190, 255};

[[nodiscard]] grid::BrickGrid rotation_columns(const grid::BrickView& shear);

// Returns a table that draws columns in a volume: translucent, of one color for each sense.
[[nodiscard]] ColorTable rotation_colors();

}  // namespace stormcellar::render
