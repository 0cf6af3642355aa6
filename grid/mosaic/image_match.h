// grid/mosaic/image_match.h -- finds how many pixels a part of one image must move to match another
// image.
//
// Only code inside grid/ uses this.
//
// Threads   Plain values and pure functions.
#pragma once

#include <optional>

#include "grid/mosaic/echo_image.h"

namespace stormcellar::grid {

// The pixels [x0, x1) x [y0, y1).
struct PixelBox {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

struct Shift {
    double x = 0, y = 0;     // shift in pixels, from `before` to `after`
    double correlation = 0;  // at the best shift
    std::size_t pixels = 0;  // number of pixels with echo in at least one image
};

// best_shift() tries shifts within +-reach_x and +-reach_y of (around_x, around_y). It moves each
// image by half of the shift, in opposite directions, so that the motion belongs to the box at the
// middle time. The correlation covers the pixels that both images have seen. A parabola through the
// best shift and its neighbors gives the fraction of a pixel. The result is none if no shift leaves
// echo in both images.
struct ShiftSearch {
    int around_x = 0, around_y = 0;
    int reach_x = 0, reach_y = 0;
};
[[nodiscard]] std::optional<Shift> best_shift(const EchoImage& before, const EchoImage& after,
                                              const PixelBox& box, const ShiftSearch& search);

}  // namespace stormcellar::grid
