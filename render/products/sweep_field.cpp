#include "render/products/sweep_field.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "stormcellar/grid/projection.h"

namespace stormcellar::render {
namespace {

constexpr double mesh_m = 8000;  // between two points that are found exactly
constexpr int widest_mesh = 16;  // in pixels or columns

// Finds azimuth and arc from the radar for a raster of points. Columns and rows are counted from
// the middle of the first point; `to_geo` returns the place of any point.
class RasterFromSite {
  public:
    template <class ToGeo>
    RasterFromSite(const grid::SitePosition& site, int width, int height, double step_m,
                   int threads, const ToGeo& to_geo)
        : step_(std::clamp(static_cast<int>(mesh_m / step_m), 1, widest_mesh)),
          across_((width + step_ - 1) / step_ + 1),
          points_(static_cast<std::size_t>(across_) *
                  static_cast<std::size_t>((height + step_ - 1) / step_ + 1)) {
        const grid::SiteFrame frame(site.latitude_deg, site.longitude_deg);
        for_each_piece(static_cast<int>(points_.size()) / across_, threads, [&](int row) {
            for (int column = 0; column < across_; ++column) {
                points_[index(column, row)] =
                    grid::SiteFrame::to_plane(frame.to_polar(to_geo(column * step_, row * step_)));
            }
        });
    }

    // Returns azimuth and arc of a point. Between the points of the mesh, the plane about the radar
    // is treated as straight.
    [[nodiscard]] grid::PolarPoint at(int x, int y) const {
        const int column = x / step_;
        const int row = y / step_;
        const double along = static_cast<double>(x % step_) / step_;
        const double down = static_cast<double>(y % step_) / step_;
        const grid::PlanePoint& a = points_[index(column, row)];
        const grid::PlanePoint& b = points_[index(column + 1, row)];
        const grid::PlanePoint& c = points_[index(column, row + 1)];
        const grid::PlanePoint& d = points_[index(column + 1, row + 1)];
        const auto mixed = [&](double grid::PlanePoint::*part) {
            return std::lerp(std::lerp(a.*part, b.*part, along), std::lerp(c.*part, d.*part, along),
                             down);
        };
        return grid::SiteFrame::from_plane(mixed(&grid::PlanePoint::x_m),
                                           mixed(&grid::PlanePoint::y_m));
    }

  private:
    [[nodiscard]] std::size_t index(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(across_) +
               static_cast<std::size_t>(column);
    }
    int step_;
    int across_;
    std::vector<grid::PlanePoint> points_;
};

// Returns true if the plane of the spec is the azimuthal equidistant plane about the radar.
bool is_about(const grid::GridSpec& spec, const grid::SitePosition& site) {
    return grid::facts_of(spec.projection).is_polar && spec.offset_x_cells == 0 &&
           spec.offset_y_cells == 0 && spec.center_latitude_deg == site.latitude_deg &&
           spec.center_longitude_deg == site.longitude_deg;
}

}  // namespace

FlatField sweep_in_picture(const grid::SweepLookup& sweep, const grid::GridSpec& spec,
                           const ViewGeometry& geometry, int threads) {
    FlatField field(geometry.width(), geometry.height());
    const auto ground_at = [&](int x, int y) {
        return geometry.ground({x + 0.5, y + 0.5}).value_or(GroundPoint{});
    };
    const auto fill = [&](const auto& place_at) {
        for_each_piece(field.height, threads, [&](int y) {
            for (int x = 0; x < field.width; ++x) {
                const GroundPoint p = ground_at(x, y);
                if (std::abs(p.x_m) > geometry.half_x_m() || std::abs(p.y_m) > geometry.half_y_m())
                    continue;
                const grid::GateValue gate = sweep.at(place_at(x, y, p));
                field.put(field.index(x, y), gate.status, gate.value);
            }
        });
    };
    if (is_about(spec, sweep.site())) {
        fill([](int, int, GroundPoint p) { return grid::SiteFrame::from_plane(p.x_m, p.y_m); });
        return field;
    }
    const grid::GridProjection projection(spec);
    const RasterFromSite raster(
        sweep.site(), field.width, field.height, geometry.metres_per_pixel(), threads,
        [&](int x, int y) {
            const GroundPoint p = ground_at(x, y);
            return projection.to_geo({p.x_m / spec.cell_width_m() + 0.5 * (spec.nx - 1),
                                      p.y_m / spec.cell_height_m() + 0.5 * (spec.ny - 1)});
        });
    fill([&](int x, int y, GroundPoint) { return raster.at(x, y); });
    return field;
}

FlatField sweep_in_columns(const grid::SweepLookup& sweep, const grid::GridSpec& spec,
                           int threads) {
    FlatField field(spec.nx, spec.ny);
    const auto fill = [&](const auto& place_at) {
        for_each_piece(field.height, threads, [&](int iy) {
            for (int ix = 0; ix < field.width; ++ix) {
                const grid::GateValue gate = sweep.at(place_at(ix, iy));
                field.put(field.index(ix, iy), gate.status, gate.value);
            }
        });
    };
    if (is_about(spec, sweep.site())) {
        fill([&](int ix, int iy) {
            return grid::SiteFrame::from_plane(spec.x_m(ix), spec.y_m(iy));
        });
        return field;
    }
    const grid::GridProjection projection(spec);
    const RasterFromSite raster(
        sweep.site(), field.width, field.height, spec.cell_width_m(), threads, [&](int ix, int iy) {
            return projection.to_geo({static_cast<double>(ix), static_cast<double>(iy)});
        });
    fill([&](int ix, int iy) { return raster.at(ix, iy); });
    return field;
}

}  // namespace stormcellar::render
