// render/volume/band_caster.h -- draws one row of tiles of the picture, and decides which of its
// rays must be cast.
//
// If cells are larger than pixels, the picture is smooth inside them. So rays are first cast on a
// grid of `stride` pixels. Then the stride is halved again and again, down to every pixel. Pixels
// in between are interpolated if the picture is nearly straight there; otherwise their rays are
// cast. The second differences of the colors on the grid tell how straight the picture is: in the
// middle between two neighbors, a straight line is off by an eighth of the second difference. If
// the stride is at most the width of a cell, the first rays miss no cell.
//
// Threads   Immutable. Many threads may work on the bands of one pass; a pass may begin only when
//           the previous pass has ended.
#pragma once

#include <cstdint>
#include <vector>

#include "render/volume/ray_maker.h"
#include "render/volume/ray_packet.h"
#include "render/volume/slice_mask.h"

namespace stormcellar::render {

struct PixelSteps {
    int stride = 1;       // 1, 2, 4 or 8
    float tolerance = 0;  // for each channel and for alpha, 0..1
};

class BandCaster {
  public:
    // All arguments must outlive the object. `rgba` has four floats for each pixel of the whole
    // picture. `light` has one float for each pixel, or is null if the volume has no light.
    BandCaster(const PacketVolume& volume, const RayMaker& maker, const SliceMask& mask, int width,
               int height, float* rgba, float* light);

    // Clears the row of tiles, and draws every `stride`-th pixel in both directions.
    void cast_first(int tile_row, int stride) const;
    // Halves the stride of the grid, which is `stride` pixels before the call.
    void refine(int tile_row, int stride, float tolerance) const;

  private:
    class Tiles;
    class Bends;
    [[nodiscard]] float* at(int x, int y) const {
        return rgba_ + (static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                        static_cast<std::size_t>(x)) *
                           4;
    }
    [[nodiscard]] float* light_at(int x, int y) const {
        return light_ + (static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                         static_cast<std::size_t>(x));
    }
    template <class Ask>
    void for_each_pixel(int tile_row, int stride, Ask ask) const;
    [[nodiscard]] bool bends(int x, int y, int stride, float most) const;
    void refine_cell(Tiles& tiles, int x, int y, int stride, const Bends& bends) const;
    void interpolate(int x, int y, int stride) const;

    const PacketVolume& volume_;
    const RayMaker& maker_;
    const SliceMask& mask_;
    int width_, height_;
    float* rgba_;
    float* light_;
};

}  // namespace stormcellar::render
