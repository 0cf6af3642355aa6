#include "render/volume/haze.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "render/image/shades.h"
#include "render/volume/level_position.h"

namespace stormcellar::render {
namespace {

constexpr int cells_across = 4, cells_up = 2;
constexpr int pixel_stride = 4;

// The share of cells that were not seen, in each coarse cell.
class UnseenAir {
  public:
    UnseenAir(const grid::BrickView& view, int threads)
        : nx_((view.spec->nx + cells_across - 1) / cells_across),
          ny_((view.spec->ny + cells_across - 1) / cells_across),
          nz_((view.spec->nz() + cells_up - 1) / cells_up),
          share_(static_cast<std::size_t>(nx_) * static_cast<std::size_t>(ny_) *
                 static_cast<std::size_t>(nz_)) {
        for_each_piece(nx_, threads, [&](int x) {
            for (int y = 0; y < ny_; ++y) {
                for (int z = 0; z < nz_; ++z)
                    share_[index(x, y, z)] = share_of(view, x, y, z);
            }
        });
    }

    // Returns the share at a place in cells and levels.
    [[nodiscard]] float at(double x, double y, double z) const {
        const auto coarse = [](double place, int cells, int count) {
            return std::clamp(static_cast<int>((place + 0.5) / cells), 0, count - 1);
        };
        return share_[index(coarse(x, cells_across, nx_), coarse(y, cells_across, ny_),
                            coarse(z, cells_up, nz_))];
    }

  private:
    [[nodiscard]] std::size_t index(int x, int y, int z) const {
        return (static_cast<std::size_t>(x) * static_cast<std::size_t>(ny_) +
                static_cast<std::size_t>(y)) *
                   static_cast<std::size_t>(nz_) +
               static_cast<std::size_t>(z);
    }

    // Returns the share of unseen cells in a coarse cell. Every coarse cell is within one brick.
    static float share_of(const grid::BrickView& view, int x, int y, int z) {
        const grid::GridSpec& spec = *view.spec;
        const std::size_t brick =
            view.brick_index(x * cells_across / grid::brick_edge,
                             y * cells_across / grid::brick_edge, z * cells_up / grid::brick_edge);
        const grid::BrickEntry& entry = view.bricks[brick];
        if (entry.kind == grid::BrickKind::uniform) {
            return entry.uniform_status == grid::CellStatus::not_seen ? 1.0F : 0.0F;
        }
        int unseen = 0, all = 0;
        for (int ix = x * cells_across; ix < std::min((x + 1) * cells_across, spec.nx); ++ix) {
            for (int iy = y * cells_across; iy < std::min((y + 1) * cells_across, spec.ny); ++iy) {
                for (int iz = z * cells_up; iz < std::min((z + 1) * cells_up, spec.nz()); ++iz) {
                    const bool seen = view.status(ix, iy, iz) != grid::CellStatus::not_seen;
                    unseen += seen ? 0 : 1;
                    ++all;
                }
            }
        }
        return static_cast<float>(unseen) / static_cast<float>(std::max(all, 1));
    }

    int nx_, ny_, nz_;
    std::vector<float> share_;
};

class HazeMarcher {
  public:
    HazeMarcher(const grid::BrickView& view, const ViewGeometry& geometry, int threads)
        : geometry_(geometry),
          spec_(*view.spec),
          air_(view, threads),
          levels_(spec_, 1),
          depth_m_(geometry.far_m() - geometry.near_m()) {}

    // Returns the opacity of the haze along the ray of a pixel.
    [[nodiscard]] float opacity(Pixel pixel) const {
        constexpr int steps = 192;
        const Vec3 start = geometry_.point(pixel, geometry_.near_m());
        const Vec3 along = geometry_.along(pixel);
        const double step = depth_m_ / steps;
        const double drawn_m = step * std::hypot(along[0], along[1], along[2]);
        double way_m = 0;
        for (int i = 0; i < steps; ++i) {
            const double depth = (i + 0.5) * step;
            way_m += drawn_m * unseen_at({start[0] + depth * along[0], start[1] + depth * along[1],
                                          start[2] + depth * along[2]});
        }
        return static_cast<float>(most_haze * (1 - std::exp(-way_m / (0.2 * depth_m_))));
    }

  private:
    // Returns the share at a point of drawn space; none outside the box.
    [[nodiscard]] double unseen_at(const Vec3& point) const {
        const double height_m = geometry_.height_at(point);
        const bool inside = std::abs(point[0]) < geometry_.half_x_m() &&
                            std::abs(point[1]) < geometry_.half_y_m() &&
                            height_m > geometry_.bottom_m() && height_m < geometry_.top_m();
        if (!inside) return 0;
        const double x = (point[0] - spec_.x_from_middle_m(0)) / spec_.cell_width_m();
        const double y = (point[1] - spec_.y_from_middle_m(0)) / spec_.cell_height_m();
        return static_cast<double>(air_.at(x, y, levels_(static_cast<float>(height_m))));
    }

    const ViewGeometry& geometry_;
    const grid::GridSpec& spec_;
    UnseenAir air_;
    LevelPosition levels_;
    double depth_m_;
};

}  // namespace

Rgba8 veiled(Rgba8 color, Rgba8 haze, double opacity) {
    return mixed(color, haze, opacity);
}

void draw_haze(const grid::BrickView& view, const ViewGeometry& geometry, Rgba8 haze, int threads,
               Image& picture) {
    const HazeMarcher marcher(view, geometry, threads);
    const int across = (picture.width + pixel_stride - 1) / pixel_stride + 1;
    const int down = (picture.height + pixel_stride - 1) / pixel_stride + 1;
    std::vector<float> opacity(static_cast<std::size_t>(across) * static_cast<std::size_t>(down));
    const auto at = [&](int column, int row) -> float& {
        return opacity[static_cast<std::size_t>(row) * static_cast<std::size_t>(across) +
                       static_cast<std::size_t>(column)];
    };
    for_each_piece(down, threads, [&](int row) {
        for (int column = 0; column < across; ++column)
            at(column, row) =
                marcher.opacity({column * pixel_stride + 0.5, row * pixel_stride + 0.5});
    });
    for_each_piece(picture.height, threads, [&](int y) {
        const int row = y / pixel_stride;
        const float down_share = static_cast<float>(y % pixel_stride) / pixel_stride;
        for (int x = 0; x < picture.width; ++x) {
            const int column = x / pixel_stride;
            const float share = static_cast<float>(x % pixel_stride) / pixel_stride;
            const float upper = std::lerp(at(column, row), at(column + 1, row), share);
            const float lower = std::lerp(at(column, row + 1), at(column + 1, row + 1), share);
            picture.set(x, y, veiled(picture.at(x, y), haze, std::lerp(upper, lower, down_share)));
        }
    });
}

}  // namespace stormcellar::render
