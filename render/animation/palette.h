// render/animation/palette.h -- one palette for all frames of a loop.
//
// A histogram is fed every frame, a palette is made from it, and a map turns pixels into entries.
// A loop with no more colours than the palette gets them exactly. Otherwise colours are grouped by
// variance-based splitting (Wan, Wong and Prusinkiewicz 1988) over cells of 4x4x4 colours,
// improved by two rounds of k-means (Lloyd 1982). A group of which one colour makes up half is
// shown as that colour, so background, text and legend stay exact. No dithering: it would crawl
// from frame to frame. Alpha is ignored. Same input, same palette. Thread contract: none of these
// may be shared while it is changed.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <unordered_set>
#include <vector>

#include "stormcellar/render/image.h"

namespace stormcellar::render {

using Rgb8 = std::array<std::uint8_t, 3>;

class ColourHistogram {
  public:
    ColourHistogram();
    void add(const Image& frame);

    // At most `size` (2 to 256) colours; each pixel that was added lies near one of them.
    [[nodiscard]] std::vector<Rgb8> palette(std::size_t size) const;

  private:
    // 4x4x4 neighbouring colours, and the one that may be most of them (a majority vote after
    // Boyer and Moore 1981: a colour with more than half the pixels always ends as leader).
    struct Cell {
        std::uint64_t count = 0;
        std::array<std::uint64_t, 3> sum{};
        Rgb8 leader{};
        std::uint64_t lead = 0;
    };
    void add_run(Rgb8 colour, std::uint64_t length);

    std::vector<Cell> cells_;                  // 64^3
    std::unordered_set<std::uint32_t> exact_;  // as long as there are at most 256
    bool too_many_ = false;
};

class PaletteMap {
  public:
    explicit PaletteMap(std::vector<Rgb8> palette);  // 1 to 256 colours

    // The nearest entry; the first of equals.
    [[nodiscard]] std::uint8_t nearest(Rgb8 colour);
    // One index a pixel.
    [[nodiscard]] std::vector<std::uint8_t> indices(const Image& frame);
    [[nodiscard]] const std::vector<Rgb8>& palette() const { return palette_; }

  private:
    struct Known {
        std::uint32_t colour = 0xFFFFFFFF;  // no colour
        std::uint8_t index = 0;
    };
    std::vector<Rgb8> palette_;
    std::vector<Known> known_;  // what was looked up lately, by a hash of the colour
};

}  // namespace stormcellar::render
