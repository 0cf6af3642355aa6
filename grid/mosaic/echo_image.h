// grid/mosaic/echo_image.h -- a grid seen from above, coarse: what motion is estimated from.
//
// A pixel is the mean of its columns' maxima, as decibels above `floor_dbz` (0 where there is no
// echo or less). A pixel is seen when half of its columns are, at any level of those that count.
// Levels below `lowest_m` do not count where there are others: ground clutter stands still.
// Thread contract: plain values.
#pragma once

#include <cstdint>
#include <vector>

#include "stormcellar/grid/brick_view.h"

namespace stormcellar::grid {

struct EchoImage {
    int width = 0, height = 0;       // west to east, south to north
    int cells = 1;                   // columns along the side of a pixel
    std::vector<float> echo_db;      // above the floor; row by row
    std::vector<std::uint8_t> seen;  // 1 or 0

    [[nodiscard]] std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
               static_cast<std::size_t>(x);
    }
};

struct EchoImageOptions {
    int cells = 1;
    float floor_dbz = 5;
    double lowest_m = 1500;
};
[[nodiscard]] EchoImage echo_image(const BrickView& view, const EchoImageOptions& options);

// Four pixels become one: their mean, seen where at least two are.
[[nodiscard]] EchoImage halved(const EchoImage& image);

}  // namespace stormcellar::grid
