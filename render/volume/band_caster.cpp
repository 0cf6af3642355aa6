#include "render/volume/band_caster.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace stormcellar::render {

// The steps of a row of tiles, and the pixels of one of its tiles that wait for their rays.
class BandCaster::Tiles {
  public:
    Tiles(const BandCaster& caster, int tile_row) : caster_(caster) {
        any_ = caster.mask_.fill_band(tile_row, words_);
    }
    [[nodiscard]] bool any() const { return any_; }

    // False for a tile in which nothing shows.
    bool enter(int tile) {
        const std::size_t per_tile = caster_.mask_.words_per_tile();
        bits_ = words_.data() + static_cast<std::size_t>(tile) * per_tile;
        return std::any_of(bits_, bits_ + per_tile, [](std::uint64_t w) { return w != 0; });
    }
    void want(int x, int y) {
        wanted_[count_++] = {x, y};
        if (count_ == wanted_.size()) cast_wanted();
    }
    void cast_wanted() {
        if (count_ == 0) return;
        const std::span<const PixelPlace> pixels = std::span(wanted_).first(count_);
        float colours[packet_rays * 4];
        cast_packet(caster_.volume_, caster_.maker_.packet(pixels), bits_,
                    caster_.mask_.words_per_tile(), colours);
        for (std::size_t i = 0; i < count_; ++i)
            std::copy_n(colours + i * 4, 4, caster_.at(wanted_[i].x, wanted_[i].y));
        count_ = 0;
    }

  private:
    const BandCaster& caster_;
    bool any_ = false;
    std::vector<std::uint64_t> words_;
    const std::uint64_t* bits_ = nullptr;
    std::array<PixelPlace, packet_rays> wanted_{};
    std::size_t count_ = 0;
};

BandCaster::BandCaster(const PacketVolume& volume, const RayMaker& maker, const SliceMask& mask,
                       int width, int height, float* rgba)
    : volume_(volume), maker_(maker), mask_(mask), width_(width), height_(height), rgba_(rgba) {}

// Asks for the rays of every `stride`-th pixel of the row of tiles, tile by tile. A tile in which
// nothing shows stays clear: its rays would find nothing.
template <class Ask>
void BandCaster::for_each_pixel(int tile_row, int stride, Ask ask) const {
    Tiles tiles(*this, tile_row);
    if (!tiles.any()) return;
    const int top = tile_row * tile_edge;
    const int bottom = std::min(top + tile_edge, height_);
    for (int tile = 0; tile < mask_.tiles_across(); ++tile) {
        if (!tiles.enter(tile)) continue;
        const int left = tile * tile_edge;
        const int right = std::min(left + tile_edge, width_);
        // By quarters: sixteen rays of a square find more of the same than those of two rows.
        const int edge = std::max(tile_edge / 2, stride);
        for (int from_y = top; from_y < bottom; from_y += edge) {
            for (int from_x = left; from_x < right; from_x += edge) {
                for (int y = from_y; y < std::min(from_y + edge, bottom); y += stride) {
                    for (int x = from_x; x < std::min(from_x + edge, right); x += stride)
                        ask(tiles, x, y);
                }
            }
        }
        tiles.cast_wanted();
    }
}

void BandCaster::cast_first(int tile_row, int stride) const {
    for_each_pixel(tile_row, stride, [](Tiles& tiles, int x, int y) { tiles.want(x, y); });
}

void BandCaster::refine(int tile_row, int stride, float tolerance) const {
    for_each_pixel(tile_row, stride, [&](Tiles& tiles, int x, int y) {
        refine_cell(tiles, x, y, stride, tolerance);
    });
}

// Whether the picture bends at a pixel of the grid, along a row or a column. Where the picture ends
// there is no telling, and no bend.
bool BandCaster::bends(int x, int y, int stride, float most) const {
    const float* here = at(x, y);
    const auto bends_between = [&](const float* before, const float* after) {
        float largest = 0;
        for (int c = 0; c < 4; ++c)
            largest = std::max(largest, std::abs(before[c] - 2 * here[c] + after[c]));
        return largest > most;
    };
    if (x >= stride && x + stride < width_ && bends_between(at(x - stride, y), at(x + stride, y))) {
        return true;
    }
    return y >= stride && y + stride < height_ &&
           bends_between(at(x, y - stride), at(x, y + stride));
}

// Beside the picture's last column and below its last row there is nobody to lean on.
void BandCaster::refine_cell(Tiles& tiles, int x, int y, int stride, float tolerance) const {
    const int half = stride / 2;
    if (x + stride < width_ && y + stride < height_) {
        const float most = 8 * tolerance;
        if (!bends(x, y, stride, most) && !bends(x + stride, y, stride, most) &&
            !bends(x, y + stride, stride, most) && !bends(x + stride, y + stride, stride, most)) {
            return interpolate(x, y, stride);
        }
    }
    const bool has_right = x + half < width_;
    const bool has_below = y + half < height_;
    if (has_right) tiles.want(x + half, y);
    if (has_below) tiles.want(x, y + half);
    if (has_right && has_below) tiles.want(x + half, y + half);
}

void BandCaster::interpolate(int x, int y, int stride) const {
    const int half = stride / 2;
    const float* a = at(x, y);
    const float* b = at(x + stride, y);
    const float* c = at(x, y + stride);
    const float* d = at(x + stride, y + stride);
    float* right = at(x + half, y);
    float* below = at(x, y + half);
    float* middle = at(x + half, y + half);
    for (int i = 0; i < 4; ++i) {
        right[i] = 0.5F * (a[i] + b[i]);
        below[i] = 0.5F * (a[i] + c[i]);
        middle[i] = 0.25F * ((a[i] + b[i]) + (c[i] + d[i]));
    }
}

}  // namespace stormcellar::render
