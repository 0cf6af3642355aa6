#include "render/volume/band_caster.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace stormcellar::render {

// The steps of a row of tiles, and its pixels that wait for their rays. If few pixels of a tile
// need a ray, pixels of the next tiles fill the packet. Its rays then sample the steps of all these
// tiles.
class BandCaster::Tiles {
  public:
    Tiles(const BandCaster& caster, int tile_row) : caster_(caster) {
        any_ = caster.mask_.fill_band(tile_row, words_);
        packet_words_.resize(caster.mask_.words_per_tile());
    }
    [[nodiscard]] bool any() const { return any_; }

    // Returns false for a tile in which nothing shows.
    bool enter(int tile) {
        tile_ = tile;
        has_joined_ = false;
        if (tile - first_tile_ == most_tiles) cast_wanted();
        const auto words = words_of(tile);
        return std::any_of(words.begin(), words.end(), [](std::uint64_t w) { return w != 0; });
    }
    // Requests the ray of a pixel. The packet is cast when it is full, when the fourth tile after
    // its first tile is entered, or when the row of tiles ends.
    void want(int x, int y) {
        if (!has_joined_) join();
        wanted_[count_++] = {x, y};
        if (count_ == wanted_.size()) cast_wanted();
    }
    void cast_wanted() {
        if (count_ == 0) return;
        const std::span<const PixelPlace> pixels = std::span(wanted_).first(count_);
        float colors[packet_rays * 4];
        float lights[packet_rays];
        cast_packet(caster_.volume_, caster_.maker_.packet(pixels), packet_words_.data(),
                    packet_words_.size(), colors, lights);
        for (std::size_t i = 0; i < count_; ++i) {
            const auto [x, y] = wanted_[i];
            std::copy_n(colors + i * 4, 4, caster_.at(x, y));
            if (caster_.light_ != nullptr) *caster_.light_at(x, y) = lights[i];
        }
        count_ = 0;
        has_joined_ = false;
    }

  private:
    static constexpr int most_tiles = 4;

    [[nodiscard]] std::span<const std::uint64_t> words_of(int tile) const {
        const std::size_t count = packet_words_.size();
        return std::span(words_).subspan(static_cast<std::size_t>(tile) * count, count);
    }
    // Adds the steps of a tile to those of the packet, at the first pixel of the tile. A ray may
    // then sample steps of another tile. This takes time but changes nothing, because the ray finds
    // only clear values there.
    void join() {
        const auto words = words_of(tile_);
        if (count_ == 0) {
            first_tile_ = tile_;
            std::copy(words.begin(), words.end(), packet_words_.begin());
        } else {
            for (std::size_t w = 0; w < words.size(); ++w)
                packet_words_[w] |= words[w];
        }
        has_joined_ = true;
    }

    const BandCaster& caster_;
    bool any_ = false;
    std::vector<std::uint64_t> words_, packet_words_;
    int tile_ = 0, first_tile_ = 0;
    bool has_joined_ = false;  // the steps of this tile are among those of the packet
    std::array<PixelPlace, packet_rays> wanted_{};
    std::size_t count_ = 0;
};

BandCaster::BandCaster(const PacketVolume& volume, const RayMaker& maker, const SliceMask& mask,
                       int width, int height, float* rgba, float* light)
    : volume_(volume),
      maker_(maker),
      mask_(mask),
      width_(width),
      height_(height),
      rgba_(rgba),
      light_(light) {}

// Requests the rays of every `stride`-th pixel of the row of tiles, tile by tile. A tile in which
// nothing shows stays clear: its rays would find nothing.
template <class Ask>
void BandCaster::for_each_pixel(int tile_row, int stride, Ask ask) const {
    Tiles tiles(*this, tile_row);
    if (!tiles.any()) return;
    const int side = mask_.edge();
    const int top = tile_row * side;
    const int bottom = std::min(top + side, height_);
    for (int tile = 0; tile < mask_.tiles_across(); ++tile) {
        if (!tiles.enter(tile)) continue;
        const int left = tile * side;
        const int right = std::min(left + side, width_);
        // Go square by square: sixteen rays of a square share more values than sixteen rays of two
        // rows.
        const int edge = std::max(small_tile_edge, stride);
        for (int from_y = top; from_y < bottom; from_y += edge) {
            for (int from_x = left; from_x < right; from_x += edge) {
                for (int y = from_y; y < std::min(from_y + edge, bottom); y += stride) {
                    for (int x = from_x; x < std::min(from_x + edge, right); x += stride)
                        ask(tiles, x, y);
                }
            }
        }
    }
    tiles.cast_wanted();
}

void BandCaster::cast_first(int tile_row, int stride) const {
    const int top = tile_row * mask_.edge();
    const int rows = std::min(mask_.edge(), height_ - top);
    std::fill_n(at(0, top), static_cast<std::ptrdiff_t>(rows) * width_ * 4, 0.0F);
    if (light_ != nullptr) {
        std::fill_n(light_at(0, top), static_cast<std::ptrdiff_t>(rows) * width_, 0.0F);
    }
    for_each_pixel(tile_row, stride, [](Tiles& tiles, int x, int y) { tiles.want(x, y); });
}

// The pixels of a grid at which the picture bends, for the rows on which a row of tiles depends.
class BandCaster::Bends {
  public:
    Bends(const BandCaster& caster, int tile_row, int stride, float most)
        : stride_(stride), top_(tile_row * tile_edge), across_((caster.width_ - 1) / stride + 1) {
        for (int y = top_; y <= top_ + tile_edge && y < caster.height_; y += stride) {
            for (int x = 0; x < caster.width_; x += stride)
                bends_.push_back(caster.bends(x, y, stride, most) ? 1 : 0);
        }
    }
    // Returns true if the picture bends at a corner of the cell of the grid that begins at a pixel.
    [[nodiscard]] bool any(int x, int y) const {
        const char* corner = bends_.data() +
                             static_cast<std::ptrdiff_t>((y - top_) / stride_) * across_ +
                             x / stride_;
        return (corner[0] | corner[1] | corner[across_] | corner[across_ + 1]) != 0;
    }

  private:
    int stride_, top_, across_;
    std::vector<char> bends_;
};

void BandCaster::refine(int tile_row, int stride, float tolerance) const {
    // A straight line through two neighbors is off by an eighth of their second difference.
    const Bends bends(*this, tile_row, stride, 8 * tolerance);
    for_each_pixel(tile_row, stride,
                   [&](Tiles& tiles, int x, int y) { refine_cell(tiles, x, y, stride, bends); });
}

// Returns true if the picture bends at a pixel of the grid, along its row or its column, in its
// colors, its opacity or its light. At the edge of the picture, this cannot be known and counts as
// no bend.
bool BandCaster::bends(int x, int y, int stride, float most) const {
    const auto bends_along = [&](int across, int down) {
        const float* before = at(x - across, y - down);
        const float* here = at(x, y);
        const float* after = at(x + across, y + down);
        bool bends = false;
        for (int c = 0; c < 4; ++c)
            bends |= std::abs(before[c] - 2 * here[c] + after[c]) > most;
        if (light_ == nullptr) return bends;
        return bends || std::abs(*light_at(x - across, y - down) - 2 * *light_at(x, y) +
                                 *light_at(x + across, y + down)) > most;
    };
    if (x >= stride && x + stride < width_ && bends_along(stride, 0)) return true;
    return y >= stride && y + stride < height_ && bends_along(0, stride);
}

// Fills the half-way pixels of one cell of the grid. If the picture bends at none of the cell's
// corners, interpolates these pixels; otherwise casts their rays. A cell at the right or lower edge
// of the picture lacks pixels to interpolate from, so its rays are always cast.
void BandCaster::refine_cell(Tiles& tiles, int x, int y, int stride, const Bends& bends) const {
    if (x + stride < width_ && y + stride < height_ && !bends.any(x, y)) {
        return interpolate(x, y, stride);
    }
    const int half = stride / 2;
    const bool has_right = x + half < width_;
    const bool has_below = y + half < height_;
    if (has_right) tiles.want(x + half, y);
    if (has_below) tiles.want(x, y + half);
    if (has_right && has_below) tiles.want(x + half, y + half);
}

void BandCaster::interpolate(int x, int y, int stride) const {
    const int half = stride / 2;
    // `pixel` returns the numbers of a pixel; there are `count` of them.
    const auto fill = [&](auto pixel, int count) {
        const float* a = pixel(x, y);
        const float* b = pixel(x + stride, y);
        const float* c = pixel(x, y + stride);
        const float* d = pixel(x + stride, y + stride);
        float* right = pixel(x + half, y);
        float* below = pixel(x, y + half);
        float* middle = pixel(x + half, y + half);
        for (int i = 0; i < count; ++i) {
            right[i] = 0.5F * (a[i] + b[i]);
            below[i] = 0.5F * (a[i] + c[i]);
            middle[i] = 0.25F * ((a[i] + b[i]) + (c[i] + d[i]));
        }
    };
    fill([this](int px, int py) { return at(px, py); }, 4);
    if (light_ != nullptr) fill([this](int px, int py) { return light_at(px, py); }, 1);
}

}  // namespace stormcellar::render
