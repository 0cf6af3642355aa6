// render/image/area_mask.h -- computes how much of each cell of a raster is inside closed curves.
//
// Threads   One thread at a time.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "render/image/canvas.h"

namespace stormcellar::render {

class AreaMask {
  public:
    // Makes a raster of this many cells, at most 32,767 along a side. All cells are outside at
    // first.
    AreaMask(int width, int height);

    // Adds a ring. The upper left corner of the raster is (0, 0). A cell is inside if the rings
    // wind around it, so a ring in the opposite direction cuts a hole.
    void add(const std::vector<Point>& ring);
    // Marks the areas of the added rings as inside, or as outside if `inside` is false. Then
    // forgets these rings.
    void put(bool inside);

    // Returns for each cell the share that is inside, 0 to 255, row by row from the top.
    [[nodiscard]] std::vector<std::uint8_t> cells() const;

  private:
    struct Surface {
        void operator()(_cairo_surface* surface) const;
    };
    struct Context {
        void operator()(_cairo* context) const;
    };
    int width_, height_;
    std::unique_ptr<_cairo_surface, Surface> surface_;
    std::unique_ptr<_cairo, Context> context_;
};

}  // namespace stormcellar::render
