// render/volume/band_caster.h -- one row of tiles of the picture: which rays are cast, which are
// not.
//
// Where cells are larger than pixels, the picture is smooth between them. So rays are cast on a
// grid of `stride` pixels first, and then the grid is halved, down to every pixel: where the
// picture is nearly straight, the pixels between are interpolated, elsewhere cast. How straight is
// told by the second differences of the grid's colours: a straight line through two neighbours is
// off by an eighth of them in its middle. With a stride of at most a cell's width no cell falls
// between the first rays. Thread contract: immutable. Bands of one pass may be worked on by many
// threads; a pass begins when the one before it is through.
#pragma once

#include <cstdint>
#include <vector>

#include "render/volume/ray_maker.h"
#include "render/volume/ray_packet.h"
#include "render/volume/slice_mask.h"

namespace stormcellar::render {

struct PixelSteps {
    int stride = 1;       // 1, 2, 4 or 8
    float tolerance = 0;  // of each channel and of alpha, 0..1
};

class BandCaster {
  public:
    // All must outlive this; `rgba` has four floats a pixel of the whole picture.
    BandCaster(const PacketVolume& volume, const RayMaker& maker, const SliceMask& mask, int width,
               int height, float* rgba);

    // Clears the row of tiles, and draws every `stride`-th pixel both ways.
    void cast_first(int tile_row, int stride) const;
    // From a grid of `stride` pixels to one of half of it.
    void refine(int tile_row, int stride, float tolerance) const;

  private:
    class Tiles;
    class Bends;
    [[nodiscard]] float* at(int x, int y) const {
        return rgba_ + (static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                        static_cast<std::size_t>(x)) *
                           4;
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
};

}  // namespace stormcellar::render
