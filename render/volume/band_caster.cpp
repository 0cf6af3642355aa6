#include "render/volume/band_caster.h"

#include <algorithm>
#include <cmath>

namespace stormcellar::render {
namespace {

using Colour = std::array<float, 4>;  // premultiplied, and alpha

bool agree(const Colour& a, const Colour& b, float tolerance) {
    for (std::size_t c = 0; c < 4; ++c) {
        if (std::abs(a[c] - b[c]) > tolerance) return false;
    }
    return true;
}

Colour middle(const Colour& a, const Colour& b) {
    Colour mean{};
    for (std::size_t c = 0; c < 4; ++c)
        mean[c] = 0.5F * (a[c] + b[c]);
    return mean;
}

}  // namespace

// The band's pixels and one row more below, which is the next band's first.
class BandCaster::Band {
  public:
    Band(const BandCaster& caster, int tile_row)
        : caster_(caster),
          top_(tile_row * tile_edge),
          across_(caster.mask_.tiles_across() * tile_edge) {
        any_ = caster.mask_.fill_band(tile_row, words_);
        if (!any_) return;
        pixels_.resize(static_cast<std::size_t>(across_) * (tile_edge + 1));
        const std::size_t per_tile = caster.mask_.words_per_tile();
        for (int tile = 0; tile < caster.mask_.tiles_across(); ++tile) {
            const auto* bits = words_.data() + static_cast<std::size_t>(tile) * per_tile;
            tile_shows_.push_back(
                std::any_of(bits, bits + per_tile, [](std::uint64_t w) { return w != 0; }));
        }
    }
    [[nodiscard]] bool any() const { return any_; }

    // Every `stride`-th pixel both ways, the row below included where others lean on it.
    void cast_first(int stride) {
        const int past = stride == 1 ? tile_edge : tile_edge + 1;
        for (int tile = 0; tile < across_ / tile_edge; ++tile) {
            for (int y = 0; y < past; y += stride) {
                for (int x = 0; x < tile_edge; x += stride)
                    want(tile, tile * tile_edge + x, y);
            }
            cast_wanted(tile);
        }
    }

    // From a grid of `stride` pixels to one of half of it.
    void refine(int stride, float tolerance) {
        const int half = stride / 2;
        for (int tile = 0; tile < across_ / tile_edge; ++tile) {
            const int left = tile * tile_edge;
            for (int y = 0; y < tile_edge; y += stride) {
                for (int x = left; x < left + tile_edge; x += stride)
                    refine_cell(tile, x, y, stride, tolerance);
            }
            for (int x = left; half > 1 && x < left + tile_edge; x += stride)
                refine_edge(tile, x, stride, tolerance);
            cast_wanted(tile);
        }
    }

    void copy_to(float* rgba) const {
        const int rows = std::min(tile_edge, caster_.height_ - top_);
        for (int y = 0; y < rows; ++y) {
            const Colour* from = pixels_.data() + place(0, y);
            float* to = rgba + static_cast<std::size_t>(top_ + y) *
                                   static_cast<std::size_t>(caster_.width_) * 4;
            std::copy_n(from->data(), static_cast<std::size_t>(caster_.width_) * 4, to);
        }
    }

  private:
    [[nodiscard]] std::size_t place(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(across_) +
               static_cast<std::size_t>(x);
    }
    [[nodiscard]] Colour& at(int x, int y) { return pixels_[place(x, y)]; }

    void want(int tile, int x, int y) {
        if (!tile_shows_[static_cast<std::size_t>(tile)]) return;  // clear, as it is
        wanted_[wanted_count_++] = {x, y};
        if (wanted_count_ == wanted_.size()) cast_wanted(tile);
    }

    void cast_wanted(int tile) {
        if (wanted_count_ == 0) return;
        std::array<PixelPlace, packet_rays> places{};
        for (std::size_t i = 0; i < wanted_count_; ++i)
            places[i] = {wanted_[i].x, wanted_[i].y + top_};
        const std::size_t per_tile = caster_.mask_.words_per_tile();
        float rgba[packet_rays * 4];
        cast_packet(caster_.volume_, caster_.maker_.packet(std::span(places).first(wanted_count_)),
                    words_.data() + static_cast<std::size_t>(tile) * per_tile, per_tile, rgba);
        for (std::size_t i = 0; i < wanted_count_; ++i)
            std::copy_n(rgba + i * 4, 4, at(wanted_[i].x, wanted_[i].y).data());
        wanted_count_ = 0;
    }

    // Beside the picture's last column there is nobody to agree with.
    void refine_cell(int tile, int x, int y, int stride, float tolerance) {
        const int half = stride / 2;
        if (x + stride < across_) {
            const Colour& a = at(x, y);
            const Colour& b = at(x + stride, y);
            const Colour& c = at(x, y + stride);
            const Colour& d = at(x + stride, y + stride);
            if (agree(a, b, tolerance) && agree(a, c, tolerance) && agree(a, d, tolerance) &&
                agree(b, c, tolerance) && agree(b, d, tolerance) && agree(c, d, tolerance)) {
                at(x + half, y) = middle(a, b);
                at(x, y + half) = middle(a, c);
                at(x + half, y + half) = middle(middle(a, b), middle(c, d));
                return;
            }
        }
        want(tile, x + half, y);
        want(tile, x, y + half);
        want(tile, x + half, y + half);
    }

    // The row below, of which only what the next halving leans on is needed.
    void refine_edge(int tile, int x, int stride, float tolerance) {
        const int half = stride / 2;
        if (x + stride < across_ && agree(at(x, tile_edge), at(x + stride, tile_edge), tolerance)) {
            at(x + half, tile_edge) = middle(at(x, tile_edge), at(x + stride, tile_edge));
        } else {
            want(tile, x + half, tile_edge);
        }
    }

    const BandCaster& caster_;
    int top_, across_;
    bool any_ = false;
    std::vector<std::uint64_t> words_;
    std::vector<bool> tile_shows_;
    std::vector<Colour> pixels_;
    std::array<PixelPlace, packet_rays> wanted_{};
    std::size_t wanted_count_ = 0;
};

BandCaster::BandCaster(const PacketVolume& volume, const RayMaker& maker, const SliceMask& mask,
                       int width, int height, const PixelSteps& steps)
    : volume_(volume), maker_(maker), mask_(mask), width_(width), height_(height), steps_(steps) {}

void BandCaster::cast(int tile_row, float* rgba) const {
    Band band(*this, tile_row);
    if (!band.any()) return;
    band.cast_first(steps_.stride);
    for (int stride = steps_.stride; stride > 1; stride /= 2)
        band.refine(stride, steps_.tolerance);
    band.copy_to(rgba);
}

}  // namespace stormcellar::render
