// render/volume/haze.h -- air that no beam saw, as a veil behind the echo.
//
// A ray's opacity of haze is most_haze * (1 - exp(-s / L)), s its way through air that was not
// seen, in metres of drawn space, L a fifth of the depth of the box. Seen air, with echo or
// without, is clear of it. It lies behind all echo, so that colours stay exact.
// Accuracy: which cells were not seen is kept by their share in coarse cells of 4 x 4 columns and
// 2 levels, rays are cast for every fourth pixel both ways and interpolated between: a veil has no
// edges that matter. Thread contract: pure; the same bits for any number of threads.
#pragma once

#include "stormcellar/grid/brick_view.h"
#include "stormcellar/render/image.h"
#include "stormcellar/render/view_geometry.h"

namespace stormcellar::render {

inline constexpr double most_haze = 0.6;

// A colour behind so much haze.
[[nodiscard]] Rgba8 veiled(Rgba8 colour, double opacity);

// Over `picture`, of the geometry's size.
void draw_haze(const grid::BrickView& view, const ViewGeometry& geometry, int threads,
               Image& picture);

}  // namespace stormcellar::render
