// render/products/water_mask.h -- tells which parts of the ground of a picture are sea or lake.
//
// Threads   Plain data.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "stormcellar/render/view_geometry.h"

namespace stormcellar::render {

// A raster over a part of the ground.
struct WaterMask {
    double west_m = 0, north_m = 0;  // its upper left corner
    double metres_per_cell = 1;
    int width = 0, height = 0;
    std::vector<std::uint8_t> water;  // the share of each cell, 0 to 255; row by row from the north

    // Returns the share of water at a place, 0..1, linear between the centers of cells. Outside the
    // raster, it returns the share at the nearest place in it. An empty mask is all land.
    [[nodiscard]] double water_at(GroundPoint p) const {
        if (water.empty()) return 0;
        return share_at((p.x_m - west_m) / metres_per_cell - 0.5,
                        (north_m - p.y_m) / metres_per_cell - 0.5);
    }

    // Returns the share of water at a place in the raster, counted in cells from the middle of the
    // first cell. The mask must not be empty.
    [[nodiscard]] double share_at(double place_x, double place_y) const {
        const double x = std::clamp(place_x, 0.0, width - 1.0);
        const double y = std::clamp(place_y, 0.0, height - 1.0);
        const int left = std::min(static_cast<int>(x), std::max(0, width - 2));
        const int top = std::min(static_cast<int>(y), std::max(0, height - 2));
        const std::size_t to_right = width > 1 ? 1 : 0;
        const std::size_t down = height > 1 ? static_cast<std::size_t>(width) : 0;
        const std::uint8_t* const corner =
            water.data() + static_cast<std::size_t>(top) * static_cast<std::size_t>(width) +
            static_cast<std::size_t>(left);
        // Most places are far from any shore.
        const bool is_plain = corner[0] == corner[to_right] && corner[0] == corner[down] &&
                              corner[0] == corner[down + to_right];
        if (is_plain) return corner[0] == 0 ? 0 : corner[0] / 255.0;
        const auto row = [&](const std::uint8_t* cells) {
            return std::lerp(static_cast<double>(cells[0]), static_cast<double>(cells[to_right]),
                             x - left);
        };
        return std::lerp(row(corner), row(corner + down), y - top) / 255;
    }
};

}  // namespace stormcellar::render
