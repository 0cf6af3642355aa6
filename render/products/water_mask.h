// render/products/water_mask.h -- where the ground of a picture is sea or lake.
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

    // Returns the share of water at a place, 0..1: straight between the centers of the cells, and
    // that of the nearest cell outside the raster. An empty mask is all land.
    [[nodiscard]] double water_at(GroundPoint p) const {
        if (water.empty()) return 0;
        const double x = std::clamp((p.x_m - west_m) / metres_per_cell - 0.5, 0.0, width - 1.0);
        const double y = std::clamp((north_m - p.y_m) / metres_per_cell - 0.5, 0.0, height - 1.0);
        const int left = std::min(static_cast<int>(x), std::max(0, width - 2));
        const int top = std::min(static_cast<int>(y), std::max(0, height - 2));
        const int right = std::min(left + 1, width - 1);
        const int bottom = std::min(top + 1, height - 1);
        const double corner = at(left, top);
        // Most places are far from any shore.
        if (corner == at(right, top) && corner == at(left, bottom) && corner == at(right, bottom))
            return corner / 255;
        const auto row = [&](int iy) { return std::lerp(at(left, iy), at(right, iy), x - left); };
        return std::lerp(row(top), row(bottom), y - top) / 255;
    }

  private:
    [[nodiscard]] double at(int x, int y) const {
        return water[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                     static_cast<std::size_t>(x)];
    }
};

}  // namespace stormcellar::render
