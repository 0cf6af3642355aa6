#include "render/still/degree_picture.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/parallel.h"
#include "render/still/map_raster.h"
#include "stormcellar/grid/projection.h"

namespace stormcellar::render {
namespace {

constexpr int mesh_step = 8;  // pixels

struct PixelSize {
    int width = 0, height = 0;
};

PixelSize size_of(const grid::GridSpec& spec, const EarthBox& box) {
    const double cell_deg =
        spec.in_degrees() ? spec.spacing_deg
                          : spec.spacing_m / grid::degree_length(spec.center_latitude_deg).north_m;
    const double radian = std::numbers::pi / 180;
    const double squeeze =
        spec.in_degrees() ? 1 : std::max(0.01, std::cos(spec.center_latitude_deg * radian));
    double across = 2 * (box.east_deg - box.west_deg) * squeeze / cell_deg;
    double down = 2 * (box.north_deg - box.south_deg) / cell_deg;
    const double shrink = std::min(1.0, most_degree_pixels / std::max(across, down));
    across *= shrink;
    down *= shrink;
    const auto whole = [](double pixels) {
        return std::max(1, static_cast<int>(std::lround(pixels)));
    };
    return {whole(across), whole(down)};
}

// A mesh over the pixels, with the place on the grid for each corner.
class DegreeMesh {
  public:
    DegreeMesh(const grid::GridProjection& projection, const EarthBox& box, PixelSize size,
               int threads)
        : across_((size.width + mesh_step - 1) / mesh_step + 1),
          down_((size.height + mesh_step - 1) / mesh_step + 1),
          places_(static_cast<std::size_t>(across_) * static_cast<std::size_t>(down_)) {
        for_each_piece(down_, threads, [&](int row) {
            for (int column = 0; column < across_; ++column) {
                const double x = column * mesh_step;
                const double y = row * mesh_step;
                const grid::GeoPoint place{std::lerp(box.north_deg, box.south_deg, y / size.height),
                                           std::lerp(box.west_deg, box.east_deg, x / size.width)};
                places_[index(column, row)] = projection.to_column(place);
            }
        });
    }

    [[nodiscard]] grid::ColumnPoint at(double x, double y) const {
        const double mesh_x = x / mesh_step;
        const double mesh_y = y / mesh_step;
        const int column = std::min(static_cast<int>(mesh_x), across_ - 2);
        const int row = std::min(static_cast<int>(mesh_y), down_ - 2);
        const double right = mesh_x - column;
        const double below = mesh_y - row;
        const auto mixed = [&](double grid::ColumnPoint::*part) {
            const auto along = [&](int in_row) {
                return std::lerp(places_[index(column, in_row)].*part,
                                 places_[index(column + 1, in_row)].*part, right);
            };
            return std::lerp(along(row), along(row + 1), below);
        };
        return {mixed(&grid::ColumnPoint::x), mixed(&grid::ColumnPoint::y)};
    }

  private:
    [[nodiscard]] std::size_t index(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(across_) +
               static_cast<std::size_t>(column);
    }

    int across_, down_;
    std::vector<grid::ColumnPoint> places_;
};

}  // namespace

Result<DegreePicture> draw_in_degrees(const grid::GridSpec& spec, const FlatField& field,
                                      const ColorTable& table, int threads) {
    const grid::GridProjection projection(spec);
    for (const double pole_deg : {-90.0, 90.0}) {
        if (!spec.in_degrees() && is_on_grid(spec, projection.to_column({pole_deg, 0}))) {
            return fail(ErrorCode::unsupported,
                        "a grid that holds a pole cannot be laid over latitude and longitude");
        }
    }
    DegreePicture drawn{earth_box_of(spec), {}};
    const EarthBox box = drawn.box;
    const PixelSize size = size_of(spec, box);
    const DegreeMesh mesh(projection, box, size, threads);
    drawn.image = Image(size.width, size.height, {0, 0, 0, 0});
    for_each_piece(size.height, threads, [&](int y) {
        for (int x = 0; x < size.width; ++x) {
            const grid::ColumnPoint at = mesh.at(x + 0.5, y + 0.5);
            if (!is_on_grid(spec, at)) continue;
            const auto ix = static_cast<int>(std::lround(at.x));
            const auto iy = static_cast<int>(std::lround(at.y));
            const std::size_t place =
                field.index(std::clamp(ix, 0, spec.nx - 1), std::clamp(iy, 0, spec.ny - 1));
            drawn.image.set(x, y, overlay_color(field, place, table));
        }
    });
    const double turn = std::floor((box.west_deg + 180) / 360) * 360;
    drawn.box.west_deg -= turn;
    drawn.box.east_deg -= turn;
    return drawn;
}

}  // namespace stormcellar::render
