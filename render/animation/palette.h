// render/animation/palette.h -- makes one palette for all frames of a loop.
//
// A histogram collects the colors of all frames. A palette is made from the histogram, and a map
// turns pixels into entries of the palette. If a loop has no more colors than fit into the palette,
// the palette holds exactly these colors. Otherwise variance-based splitting (Wan, Wong and
// Prusinkiewicz 1988) groups cells of 4x4x4 colors, and two rounds of k-means (Lloyd 1982) improve
// the groups. If one color makes up at least half of a group, the group gets exactly that color. So
// background, text and legend stay exact. There is no dithering, because its dots would move from
// frame to frame. Alpha is ignored. The same input gives the same palette.
//
// Threads   One thread at a time for each object.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <unordered_set>
#include <vector>

#include "stormcellar/render/image.h"

namespace stormcellar::render {

using Rgb8 = std::array<std::uint8_t, 3>;

class ColorHistogram {
  public:
    ColorHistogram();
    void add(const Image& frame);

    // Returns at most `size` (2 to 256) colors. Each pixel that was added is near one of these
    // colors.
    [[nodiscard]] std::vector<Rgb8> palette(std::size_t size) const;

  private:
    // A cell of 4x4x4 neighboring colors, with a leader, which is the only color that may have more
    // than half of the pixels. A majority vote finds it (Boyer and Moore 1981): if a color has more
    // than half of the pixels, it always becomes the leader.
    struct Cell {
        std::uint64_t count = 0;
        std::array<std::uint64_t, 3> sum{};
        Rgb8 leader{};
        std::uint64_t lead = 0;
    };
    void add_run(Rgb8 color, std::uint64_t length);

    std::vector<Cell> cells_;                  // 64^3
    std::unordered_set<std::uint32_t> exact_;  // the colors, while there are at most 256
    bool too_many_ = false;
};

class PaletteMap {
  public:
    explicit PaletteMap(std::vector<Rgb8> palette);  // 1 to 256 colors

    // Returns the index of the nearest entry, or of the first if several are equally near.
    [[nodiscard]] std::uint8_t nearest(Rgb8 color);
    // Returns one index for each pixel.
    [[nodiscard]] std::vector<std::uint8_t> indices(const Image& frame);
    [[nodiscard]] const std::vector<Rgb8>& palette() const { return palette_; }

  private:
    struct Known {
        std::uint32_t color = 0xFFFFFFFF;  // not a color
        std::uint8_t index = 0;
    };
    std::vector<Rgb8> palette_;
    std::vector<Known> known_;  // recent lookups, by a hash of the color
};

}  // namespace stormcellar::render
