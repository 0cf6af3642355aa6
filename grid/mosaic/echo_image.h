// grid/mosaic/echo_image.h -- makes a coarse image of a grid seen from above, to estimate motion.
//
// A pixel is the mean over its seen columns. Each column counts with its maximum, in decibels above
// `floor_dbz`; below the floor, or without echo, it counts as 0. A pixel is seen if at least half
// of its columns are seen at any level that counts. Levels below `lowest_m` do not count if the
// grid has higher levels, because echo near the ground may be clutter, which does not move.
//
// Threads   Plain values.
#pragma once

#include <cstdint>
#include <vector>

#include "stormcellar/grid/brick_view.h"

namespace stormcellar::grid {

struct EchoImage {
    int width = 0, height = 0;       // west to east, south to north
    int cells = 1;                   // number of columns along each side of a pixel
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

// Returns an image with one pixel for each square of four pixels: the mean of the seen pixels of
// the square. The new pixel is seen if at least two of the four are seen.
[[nodiscard]] EchoImage halved(const EchoImage& image);

}  // namespace stormcellar::grid
