#include "render/volume/slicer.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "render/volume/level_position.h"
#include "render/volume/ray_packet.h"
#include "render/volume/slice_mask.h"
#include "render/volume/transfer_function.h"

namespace stormcellar::render {
namespace {

static_assert(tile_edge == packet_rays, "a packet is a row of a tile");

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
          z_offset_(levels.is_uniform() ? levels.offset() : 0),
          low_{-geometry.half_x_m(), -geometry.half_y_m(),
               geometry.bottom_m() * geometry.exaggeration()},
          high_{geometry.half_x_m(), geometry.half_y_m(),
                geometry.top_m() * geometry.exaggeration()} {}

    // The rays of 8 pixels side by side; those beyond `width` see nothing.
    [[nodiscard]] RayPacket packet(int left, int y, int width) const {
        RayPacket rays{};
        const Vec3& forward = geometry_.forward();
        rays.step_x = static_cast<float>(forward[0] * step_m_ / width_m_);
        rays.step_y = static_cast<float>(forward[1] * step_m_ / height_m_);
        rays.step_z = static_cast<float>(forward[2] * step_m_ * z_slope_);
        for (int i = 0; i < packet_rays; ++i) {
            const Vec3 start = geometry_.point({left + i + 0.5, y + 0.5}, geometry_.near_m());
            rays.x[i] = static_cast<float>((start[0] - first_x_m_) / width_m_);
            rays.y[i] = static_cast<float>((start[1] - first_y_m_) / height_m_);
            rays.z[i] = static_cast<float>(z_offset_ + start[2] * z_slope_);
            if (left + i < width) clip(start, rays.enter[i], rays.leave[i]);
        }
        return rays;
    }

  private:
    void clip(const Vec3& start, float& enter, float& leave) const {
        double first = 0;
        double last = slices_;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double along = geometry_.forward()[axis] * step_m_;
            if (along == 0) {
                if (start[axis] < low_[axis] || start[axis] > high_[axis]) last = -1;
                continue;
            }
            const double a = (low_[axis] - start[axis]) / along;
            const double b = (high_[axis] - start[axis]) / along;
            first = std::max(first, std::min(a, b));
            last = std::min(last, std::max(a, b));
        }
        if (!(first < last)) return;
        enter = static_cast<float>(first);
        leave = static_cast<float>(last);
    }

    const ViewGeometry& geometry_;
    int slices_;
    double step_m_;
    double width_m_, height_m_, first_x_m_, first_y_m_;
    double z_slope_, z_offset_;
    Vec3 low_, high_;
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

Layer slice_volume(const grid::BrickView& view, const ColourTable& table,
                   const ViewGeometry& geometry, int slices, double opacity, int threads) {
    Layer layer{geometry.width(), geometry.height(), {}};
    layer.rgba.resize(static_cast<std::size_t>(layer.width) *
                      static_cast<std::size_t>(layer.height) * 4);
    const double step_m = (geometry.far_m() - geometry.near_m()) / slices;
    const TransferFunction transfer(table, view.quantization, opacity, step_m);
    const LevelPosition levels(*view.spec, geometry.exaggeration());
    const PacketVolume volume(view, levels, transfer);
    const RayMaker maker(*view.spec, geometry, levels, slices);
    const SliceMask mask(view, geometry, slices, transfer.first_visible_code());
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
