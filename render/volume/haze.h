// render/volume/haze.h -- draws a veil behind the echo where no beam saw the air.
//
// The opacity of the haze along a ray is most_haze * (1 - exp(-s / L)). s is the length of the ray
// through air that was not seen, in meters of drawn space; L is a fifth of the depth of the box.
// Air that was seen has no haze, whether it has echo or not. The haze is behind all echo, so that
// colors stay exact.
//
// Accuracy  A coarse cell of 4 x 4 columns and 2 levels holds only the fraction of its cells that
//           were not seen. Rays are cast for every fourth pixel in both directions and interpolated
//           in between, because a veil has no edges that matter.
// Threads   Pure; the same bits for any number of threads.
#pragma once

#include "stormcellar/grid/brick_view.h"
#include "stormcellar/render/image.h"
#include "stormcellar/render/view_geometry.h"

namespace stormcellar::render {

inline constexpr double most_haze = 0.6;

// Returns `color` covered by haze of this color and opacity. Keeps the alpha of `color`.
[[nodiscard]] Rgba8 veiled(Rgba8 color, Rgba8 haze, double opacity);

// Draws the haze over the background that is in `picture`, before the echo is drawn. `picture` has
// the size of the geometry.
void draw_haze(const grid::BrickView& view, const ViewGeometry& geometry, Rgba8 haze, int threads,
               Image& picture);

}  // namespace stormcellar::render
