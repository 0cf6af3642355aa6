// grid/mosaic/image_match.h -- by how many pixels a part of one image must be moved to look like
// another.
//
// Inside the grid room only.
#pragma once

#include <optional>

#include "grid/mosaic/echo_image.h"

namespace stormcellar::grid {

// Pixels [x0, x1) x [y0, y1).
struct PixelBox {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

struct Shift {
    double x = 0, y = 0;     // pixels, from `before` to `after`
    double correlation = 0;  // at its best
    std::size_t pixels = 0;  // with echo in one of the two
};

// Shifts within +-reach_x, +-reach_y of (around_x, around_y). Half of a shift is taken from either
// image, so that it belongs to the box at the time in the middle. Correlation is of the pixels that
// both saw. Parts of a pixel by a parabola through the best and its neighbours. None where no shift
// leaves echo in both.
struct ShiftSearch {
    int around_x = 0, around_y = 0;
    int reach_x = 0, reach_y = 0;
};
[[nodiscard]] std::optional<Shift> best_shift(const EchoImage& before, const EchoImage& after,
                                              const PixelBox& box, const ShiftSearch& search);

}  // namespace stormcellar::grid
