#include "render/volume/slicer.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/parallel.h"
#include "render/volume/level_position.h"
#include "render/volume/ray_packet.h"
#include "render/volume/slice_mask.h"
#include "render/volume/transfer_function.h"

namespace stormcellar::render {
namespace {

static_assert(tile_edge == packet_rays, "a packet is a row of a tile");

// The part of a ray, in steps, that is inside the box.
struct Stretch {
    double first = 0, last = 0;

    // Keeps where c t^2 + b t + a <= 0; c >= 0.
    void keep_below(double a, double b, double c) {
        if (c > 0) {
            const double inside = b * b - 4 * a * c;
            if (!(inside > 0)) return empty();
            const double q = -0.5 * (b + std::copysign(std::sqrt(inside), b));
            const double one = q / c;
            const double other = q == 0 ? 0 : a / q;
            return keep(std::min(one, other), std::max(one, other));
        }
        if (b == 0) return a > 0 ? empty() : void();
        b > 0 ? keep(first, -a / b) : keep(-a / b, last);
    }
    // Keeps the first stretch where c t^2 + b t + a >= 0; c >= 0.
    void keep_above(double a, double b, double c) {
        Stretch below = *this;
        below.keep_below(a, b, c);
        if (!(below.first < below.last)) {
            if (a + first * (b + first * c) < 0) empty();
            return;
        }
        below.first > first ? keep(first, below.first) : keep(below.last, last);
    }
    void keep(double from, double to) {
        first = std::max(first, from);
        last = std::min(last, to);
    }
    void empty() { last = first - 1; }
};

// Turns pixels into rays in cell positions, clipped to the box of the cells.
class RayMaker {
  public:
    RayMaker(const grid::GridSpec& spec, const ViewGeometry& geometry, const LevelPosition& levels,
             int slices)
        : geometry_(geometry),
          slices_(slices),
          step_m_((geometry.far_m() - geometry.near_m()) / slices),
          width_m_(spec.cell_width_m()),
          height_m_(spec.cell_height_m()),
          first_x_m_(spec.x_from_middle_m(0)),
          first_y_m_(spec.y_from_middle_m(0)),
          z_slope_(levels.is_uniform() ? levels.slope() : 1),
          z_offset_(levels.is_uniform() ? levels.offset() : 0) {}

    // The rays of 8 pixels side by side; those beyond `width` see nothing.
    [[nodiscard]] RayPacket packet(int left, int y, int width) const {
        RayPacket rays{};
        for (int i = 0; i < packet_rays; ++i) {
            const Pixel pixel = {left + i + 0.5, y + 0.5};
            const Vec3 start = geometry_.point(pixel, geometry_.near_m());
            const Vec3 along = geometry_.along(pixel);
            rays.step_x[i] = static_cast<float>(along[0] * step_m_ / width_m_);
            rays.step_y[i] = static_cast<float>(along[1] * step_m_ / height_m_);
            rays.step_z[i] = static_cast<float>(along[2] * step_m_ * z_slope_);
            rays.x[i] = static_cast<float>((start[0] - first_x_m_) / width_m_);
            rays.y[i] = static_cast<float>((start[1] - first_y_m_) / height_m_);
            rays.z[i] = static_cast<float>(z_offset_ + start[2] * z_slope_);
            rays.length[i] = static_cast<float>(std::hypot(along[0], along[1], along[2]));
            if (left + i < width) clip(start, along, rays.enter[i], rays.leave[i]);
        }
        return rays;
    }

    // None where the earth is drawn flat.
    [[nodiscard]] std::optional<CurvedLevels> curve() const {
        if (geometry_.drop_per_m2() == 0) return std::nullopt;
        const double factor = geometry_.drop_per_m2() * geometry_.exaggeration() * z_slope_;
        return CurvedLevels{static_cast<float>(factor * width_m_ * width_m_),
                            static_cast<float>(factor * height_m_ * height_m_),
                            static_cast<float>(-first_x_m_ / width_m_),
                            static_cast<float>(-first_y_m_ / height_m_)};
    }

  private:
    void clip(const Vec3& start, const Vec3& along, float& enter, float& leave) const {
        const Vec3 step = {along[0] * step_m_, along[1] * step_m_, along[2] * step_m_};
        Stretch inside{0, static_cast<double>(slices_)};
        inside.keep_below(start[0] - geometry_.half_x_m(), step[0], 0);
        inside.keep_below(-start[0] - geometry_.half_x_m(), -step[0], 0);
        inside.keep_below(start[1] - geometry_.half_y_m(), step[1], 0);
        inside.keep_below(-start[1] - geometry_.half_y_m(), -step[1], 0);
        // Heights above the curved sea level are a polynomial of the step.
        const double curve = geometry_.drop_per_m2() * geometry_.exaggeration();
        const double a = start[2] + curve * (start[0] * start[0] + start[1] * start[1]);
        const double b = step[2] + 2 * curve * (start[0] * step[0] + start[1] * step[1]);
        const double c = curve * (step[0] * step[0] + step[1] * step[1]);
        inside.keep_below(a - geometry_.top_m() * geometry_.exaggeration(), b, c);
        inside.keep_above(a - geometry_.bottom_m() * geometry_.exaggeration(), b, c);
        if (!(inside.first < inside.last)) return;
        enter = static_cast<float>(inside.first);
        leave = static_cast<float>(inside.last);
    }

    const ViewGeometry& geometry_;
    int slices_;
    double step_m_;
    double width_m_, height_m_, first_x_m_, first_y_m_;
    double z_slope_, z_offset_;
};

void cast_tile(const PacketVolume& volume, const RayMaker& maker, int tile, int tile_row,
               const std::uint64_t* mask, std::size_t words, Layer& layer) {
    const int left = tile * tile_edge;
    const int count = std::min(tile_edge, layer.width - left);
    const int bottom = std::min((tile_row + 1) * tile_edge, layer.height);
    for (int y = tile_row * tile_edge; y < bottom; ++y) {
        float rgba[packet_rays * 4];
        cast_packet(volume, maker.packet(left, y, layer.width), mask, words, rgba);
        const std::size_t at =
            (static_cast<std::size_t>(y) * static_cast<std::size_t>(layer.width) +
             static_cast<std::size_t>(left)) *
            4;
        std::copy(rgba, rgba + count * 4, layer.rgba.data() + at);
    }
}

void cast_band(const PacketVolume& volume, const RayMaker& maker, const SliceMask& mask,
               int tile_row, Layer& layer) {
    std::vector<std::uint64_t> words;
    if (!mask.fill_band(tile_row, words)) return;
    const std::size_t per_tile = mask.words_per_tile();
    for (int tile = 0; tile < mask.tiles_across(); ++tile) {
        const std::uint64_t* bits = words.data() + static_cast<std::size_t>(tile) * per_tile;
        if (std::all_of(bits, bits + per_tile, [](std::uint64_t w) { return w == 0; })) continue;
        cast_tile(volume, maker, tile, tile_row, bits, per_tile, layer);
    }
}

std::uint8_t mixed(float front, float through, std::uint8_t back) {
    const float level = front * 255.0F + through * static_cast<float>(back);
    return static_cast<std::uint8_t>(std::clamp(level + 0.5F, 0.0F, 255.0F));
}

}  // namespace

VolumeSlicer::VolumeSlicer(const ColourTable& table, const grid::Quantization& quantization,
                           const ViewGeometry& geometry, const VolumeOptions& options)
    : geometry_(geometry),
      options_(options),
      transfer_(table, quantization, options.opacity,
                (geometry.far_m() - geometry.near_m()) / options.slices, options.integration) {}

Layer VolumeSlicer::draw(const grid::BrickView& view, int threads) const {
    Layer layer{geometry_.width(), geometry_.height(), {}};
    layer.rgba.resize(static_cast<std::size_t>(layer.width) *
                      static_cast<std::size_t>(layer.height) * 4);
    const LevelPosition levels(*view.spec, geometry_.exaggeration());
    const RayMaker maker(*view.spec, geometry_, levels, options_.slices);
    const auto curve = maker.curve();
    PacketVolume volume(view, levels, transfer_);
    if (curve) volume.curve = &*curve;
    const SliceMask mask(view, geometry_, options_.slices, transfer_);
    for_each_piece(mask.tiles_down(), threads,
                   [&](int tile_row) { cast_band(volume, maker, mask, tile_row, layer); });
    return layer;
}

void composite_over(const Layer& layer, Image& background, int left, int top) {
    for (int y = 0; y < layer.height; ++y) {
        const float* from = layer.rgba.data() +
                            static_cast<std::size_t>(y) * static_cast<std::size_t>(layer.width) * 4;
        std::uint8_t* to =
            background.rgba.data() +
            (static_cast<std::size_t>(y + top) * static_cast<std::size_t>(background.width) +
             static_cast<std::size_t>(left)) *
                4;
        for (int x = 0; x < layer.width; ++x, from += 4, to += 4) {
            if (from[3] <= 0) continue;
            for (int c = 0; c < 3; ++c)
                to[c] = mixed(from[c], 1 - from[3], to[c]);
        }
    }
}

}  // namespace stormcellar::render
