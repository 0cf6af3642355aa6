#include "render/still/plane_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <vector>

#include "render/products/smooth_field.h"
#include "render/still/map_raster.h"
#include "stormcellar/grid/projection.h"
#include "stormcellar/grid/site_frame.h"

namespace stormcellar::render {
namespace {

constexpr int largest_mesh = 64;  // pixels
constexpr double most_off = 0.1;  // pixels
constexpr double degrees_per_radian = 180 / std::numbers::pi;
constexpr double degrees_per_mercator_m = 180 / mercator_edge_m;

constexpr Rgba8 clear = {0, 0, 0, 0}, black = {0, 0, 0, 255};

using grid::ColumnPoint;

ColumnPoint mixed(ColumnPoint a, ColumnPoint b, double share) {
    return {std::lerp(a.x, b.x, share), std::lerp(a.y, b.y, share)};
}

// The places on the earth of the edges and centers of a window's pixels.
class WindowPlaces {
  public:
    explicit WindowPlaces(const PlaneWindow& window)
        : window_(window),
          across_((window.east - window.west) / window.width),
          down_((window.north - window.south) / window.height) {}

    [[nodiscard]] double longitude_deg(double x) const {
        const double at = window_.west + x * across_;
        return window_.plane == Plane::degrees ? at : at * degrees_per_mercator_m;
    }
    [[nodiscard]] double latitude_deg(double y) const {
        const double at = window_.north - y * down_;
        if (window_.plane == Plane::degrees) return std::clamp(at, -90.0, 90.0);
        return mercator_latitude_deg(at);
    }
    // Return the place of a longitude or of a latitude, in pixels.
    [[nodiscard]] double x_of(double longitude_deg) const {
        const double at = window_.plane == Plane::degrees ? longitude_deg
                                                          : longitude_deg / degrees_per_mercator_m;
        return (at - window_.west) / across_;
    }
    [[nodiscard]] double y_of(double latitude_deg) const {
        constexpr double most_deg = 89.9;
        const double at = window_.plane == Plane::degrees
                              ? latitude_deg
                              : mercator_y_m(std::clamp(latitude_deg, -most_deg, most_deg));
        return (window_.north - at) / down_;
    }

  private:
    const PlaneWindow& window_;
    double across_, down_;
};

struct PixelBox {
    int left = 0, top = 0, right = 0, bottom = 0;  // `right` and `bottom` are just beyond
    [[nodiscard]] bool is_empty() const { return left >= right || top >= bottom; }
};

// Returns the pixels that may be on the grid, if its longitudes are moved `turn_deg` to the east.
PixelBox pixels_of(const PlaneWindow& window, const EarthBox& box, double turn_deg) {
    const WindowPlaces places(window);
    const auto within = [](double pixel, int most) {
        return static_cast<int>(std::clamp(pixel, 0.0, static_cast<double>(most)));
    };
    return {within(std::floor(places.x_of(box.west_deg + turn_deg)) - 1, window.width),
            within(std::floor(places.y_of(box.north_deg)) - 1, window.height),
            within(std::ceil(places.x_of(box.east_deg + turn_deg)) + 1, window.width),
            within(std::ceil(places.y_of(box.south_deg)) + 1, window.height)};
}

// Calls work(pixels) for each copy of the grid on a plane that continues beyond 360 degrees.
template <class Work>
void for_each_copy(const PlaneWindow& window, const EarthBox& box, const Work& work) {
    const bool is_sane = window.width > 0 && window.height > 0 && window.west < window.east &&
                         window.south < window.north;
    if (!is_sane) return;
    const WindowPlaces places(window);
    const double first = std::ceil((places.longitude_deg(0) - box.east_deg) / 360 - 0.01);
    const double last =
        std::floor((places.longitude_deg(window.width) - box.west_deg) / 360 + 0.01);
    // There are more copies than pixels, so they cannot be seen.
    if (!(last - first <= window.width)) return;
    for (double turn = first; turn <= last; ++turn) {
        const PixelBox pixels = pixels_of(window, box, turn * 360);
        if (!pixels.is_empty()) work(pixels);
    }
}

// The color of the cell at a place in columns.
class PlaceColors {
  public:
    explicit PlaceColors(const PlaneMap& map)
        : map_(map), cells_(map.field), per_column_(1.0 / static_cast<double>(1 << map.halvings)) {}

    // The place must be on the grid.
    [[nodiscard]] Rgba8 at(double x, double y) {
        if (map_.sweep != nullptr && map_.halvings == 0) {
            const grid::GridSpec& plane = map_.spec;
            const grid::GateValue gate = map_.sweep->at(
                grid::SiteFrame::from_plane((x - 0.5 * (plane.nx - 1)) * plane.spacing_m,
                                            (y - 0.5 * (plane.ny - 1)) * plane.spacing_m));
            return color(gate.status, gate.value);
        }
        if (map_.smooth) {
            const SmoothField::Place place =
                cells_.at((x + 0.5) * per_column_ - 0.5, (y + 0.5) * per_column_ - 0.5);
            return color(place.status, place.value);
        }
        const int column = static_cast<int>(x + 0.5) >> map_.halvings;
        const int row = static_cast<int>(y + 0.5) >> map_.halvings;
        const std::size_t cell = map_.field.index(column, row);
        if (cell != last_cell_) {
            last_cell_ = cell;
            last_color_ = color(map_.field.status[cell], map_.field.values[cell]);
        }
        return last_color_;
    }

  private:
    [[nodiscard]] Rgba8 color(grid::CellStatus status, float value) const {
        const bool is_unseen = status == grid::CellStatus::not_seen;
        if (map_.look == PlaneLook::unseen) return is_unseen ? black : clear;
        if (map_.look == PlaneLook::echo && is_unseen) return clear;
        return overlay_color(status, value, map_.table);
    }

    const PlaneMap& map_;
    SmoothField cells_;
    double per_column_;
    std::size_t last_cell_ = static_cast<std::size_t>(-1);
    Rgba8 last_color_{};
};

// A square of pixels. corners[0] is the center of the first pixel, at the top left; corners[1] is
// the center of the pixel just beyond the square at the right. corners[2] and corners[3] are the
// same in the row just below the square.
struct Mesh {
    int left = 0, top = 0, side = 0;
    std::array<ColumnPoint, 4> corners{};
};

class PlanePainter {
  public:
    PlanePainter(const PlaneMap& map, const PlaneWindow& window, Image& image)
        : map_(map), places_(window), projection_(map.spec), colors_(map), image_(image) {}

    void draw(const PixelBox& pixels) {
        pixels_ = pixels;
        int side = largest_mesh;
        while (side > 1 &&
               side / 2 >= std::max(pixels.right - pixels.left, pixels.bottom - pixels.top))
            side /= 2;
        std::vector<ColumnPoint> above = row_of(pixels.top, side);
        for (int top = pixels.top; top < pixels.bottom; top += side) {
            const std::vector<ColumnPoint> below = row_of(top + side, side);
            for (std::size_t i = 0; i + 1 < above.size(); ++i)
                draw_mesh({pixels.left + static_cast<int>(i) * side,
                           top,
                           side,
                           {above[i], above[i + 1], below[i], below[i + 1]}});
            above = below;
        }
    }

  private:
    [[nodiscard]] ColumnPoint place_at(double x, double y) const {
        return projection_.to_column(
            {places_.latitude_deg(y + 0.5), places_.longitude_deg(x + 0.5)});
    }
    [[nodiscard]] std::vector<ColumnPoint> row_of(int y, int side) const {
        std::vector<ColumnPoint> row;
        for (int x = pixels_.left; x < pixels_.right + side; x += side)
            row.push_back(place_at(x, y));
        return row;
    }

    void draw_mesh(const Mesh& mesh) {
        if (mesh.left >= pixels_.right || mesh.top >= pixels_.bottom) return;
        if (mesh.side == 1) return set_pixel(mesh.left, mesh.top, mesh.corners[0]);
        const double half = 0.5 * mesh.side;
        const double x = mesh.left, y = mesh.top;
        const auto& [a, b, c, d] = mesh.corners;
        const ColumnPoint top = place_at(x + half, y), left = place_at(x, y + half);
        const ColumnPoint right = place_at(x + mesh.side, y + half);
        const ColumnPoint bottom = place_at(x + half, y + mesh.side);
        const ColumnPoint middle = place_at(x + half, y + half);
        // Check all five points, because a conformal map may bend the sides of a mesh but leave its
        // middle in place.
        const ColumnPoint straight = mixed(mixed(a, b, 0.5), mixed(c, d, 0.5), 0.5);
        const double off = std::max({off_by(top, mixed(a, b, 0.5)), off_by(left, mixed(a, c, 0.5)),
                                     off_by(right, mixed(b, d, 0.5)),
                                     off_by(bottom, mixed(c, d, 0.5)), off_by(middle, straight)});
        const double pixel = std::min(off_by(a, b), off_by(a, c)) / mesh.side;
        if (off <= most_off * pixel) return fill(mesh);
        const int side = mesh.side / 2;
        draw_mesh({mesh.left, mesh.top, side, {a, top, left, middle}});
        draw_mesh({mesh.left + side, mesh.top, side, {top, b, middle, right}});
        draw_mesh({mesh.left, mesh.top + side, side, {left, middle, c, bottom}});
        draw_mesh({mesh.left + side, mesh.top + side, side, {middle, right, bottom, d}});
    }
    static double off_by(ColumnPoint a, ColumnPoint b) {
        return std::max(std::abs(a.x - b.x), std::abs(a.y - b.y));
    }

    void fill(const Mesh& mesh) {
        const int right = std::min(mesh.left + mesh.side, pixels_.right);
        const int bottom = std::min(mesh.top + mesh.side, pixels_.bottom);
        const double share = 1.0 / mesh.side;
        for (int y = mesh.top; y < bottom; ++y) {
            const double down = (y - mesh.top) * share;
            ColumnPoint at = mixed(mesh.corners[0], mesh.corners[2], down);
            const ColumnPoint end = mixed(mesh.corners[1], mesh.corners[3], down);
            const ColumnPoint step{(end.x - at.x) * share, (end.y - at.y) * share};
            for (int x = mesh.left; x < right; ++x) {
                set_pixel(x, y, at);
                at = {at.x + step.x, at.y + step.y};
            }
        }
    }
    void set_pixel(int x, int y, ColumnPoint at) {
        if (!is_on_grid(map_.spec, at)) return;
        const Rgba8 color = colors_.at(at.x, at.y);
        if (color[3] != 0 || map_.look == PlaneLook::unseen)
            std::memcpy(pixel(x, y), color.data(), color.size());
    }
    [[nodiscard]] std::uint8_t* pixel(int x, int y) {
        return image_.rgba.data() +
               4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width) +
                    static_cast<std::size_t>(x));
    }

    const PlaneMap& map_;
    WindowPlaces places_;
    grid::GridProjection projection_;
    PlaceColors colors_;
    Image& image_;
    PixelBox pixels_;
};

}  // namespace

Rgba8 color_outside(PlaneLook look) {
    return look == PlaneLook::unseen ? black : clear;
}

EarthBox earth_box_of(const grid::GridSpec& spec) {
    const grid::GridProjection projection(spec);
    EarthBox box{90, -90, 1e9, -1e9};
    const auto take = [&](double x, double y) {
        const grid::GeoPoint place = projection.to_geo({x, y});
        const double longitude = projection.continuous_longitude_deg(place.longitude_deg);
        box.south_deg = std::min(box.south_deg, place.latitude_deg);
        box.north_deg = std::max(box.north_deg, place.latitude_deg);
        box.west_deg = std::min(box.west_deg, longitude);
        box.east_deg = std::max(box.east_deg, longitude);
    };
    for (int ix = 0; ix <= spec.nx; ++ix) {
        take(ix - 0.5, -0.5);
        take(ix - 0.5, spec.ny - 0.5);
    }
    for (int iy = 0; iy <= spec.ny; ++iy) {
        take(-0.5, iy - 0.5);
        take(spec.nx - 0.5, iy - 0.5);
    }
    for (const double pole_deg : {-90.0, 90.0}) {
        if (spec.in_degrees() || !is_on_grid(spec, projection.to_column({pole_deg, 0}))) continue;
        (pole_deg < 0 ? box.south_deg : box.north_deg) = pole_deg;
        box.west_deg = spec.center_longitude_deg - 180;
        box.east_deg = spec.center_longitude_deg + 180;
    }
    return box;
}

double mercator_latitude_deg(double y_m) noexcept {
    return std::atan(std::sinh(y_m / mercator_radius_m)) * degrees_per_radian;
}

double mercator_y_m(double latitude_deg) noexcept {
    return mercator_radius_m * std::asinh(std::tan(latitude_deg / degrees_per_radian));
}

bool meets(const PlaneWindow& window, const EarthBox& box) {
    bool any = false;
    for_each_copy(window, box, [&](const PixelBox& /*pixels*/) { any = true; });
    return any;
}

Image draw_on_plane(const PlaneMap& map, const PlaneWindow& window) {
    Image image(std::max(0, window.width), std::max(0, window.height), color_outside(map.look));
    PlanePainter painter(map, window, image);
    for_each_copy(window, map.box, [&](const PixelBox& pixels) { painter.draw(pixels); });
    return image;
}

}  // namespace stormcellar::render
