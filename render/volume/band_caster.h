// render/volume/band_caster.h -- one row of tiles of the picture: which rays are cast, which are
// not.
//
// Where cells are larger than pixels, neighbouring rays see nearly the same. So rays are cast on a
// grid of `stride` pixels first; between four of them whose colours agree the others are taken by
// bilinear interpolation, and elsewhere the grid is halved, down to every pixel. With a stride of
// at most half a cell's width no cell falls between the first rays. Thread contract: immutable;
// cast() may run on many threads, each with rows of its own.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "render/volume/ray_maker.h"
#include "render/volume/ray_packet.h"
#include "render/volume/slice_mask.h"

namespace stormcellar::render {

struct PixelSteps {
    int stride = 1;       // 1, 2, 4 or 8
    float tolerance = 0;  // between rays that agree: of each channel and of alpha, 0..1
};

class BandCaster {
  public:
    // All must outlive this.
    BandCaster(const PacketVolume& volume, const RayMaker& maker, const SliceMask& mask, int width,
               int height, const PixelSteps& steps);

    // Writes the pixels of the row of tiles into `rgba`, four floats a pixel of the whole picture.
    void cast(int tile_row, float* rgba) const;

  private:
    class Band;

    const PacketVolume& volume_;
    const RayMaker& maker_;
    const SliceMask& mask_;
    int width_, height_;
    PixelSteps steps_;
};

}  // namespace stormcellar::render
