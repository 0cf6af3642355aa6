#include "stormcellar/grid/grid_window.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <GeographicLib/Math.hpp>

#include "base/floating_point.h"
#include "stormcellar/grid/brick_view.h"
#include "stormcellar/grid/projection.h"

namespace stormcellar::grid {
namespace {

constexpr int circle_points = 720;
// The circle is sampled at points. Between two points, it bulges by 1e-5 of its radius. The rest of
// this factor is a margin for projections.
constexpr double bulge = 1.001;
// If two neighboring points on the circle are farther apart in the plane than on the earth, by more
// than this factor, the plane is torn between them.
constexpr double largest_stretch = 8;

// A range of columns or rows, both ends included.
struct Range {
    double least = HUGE_VAL;
    double greatest = -HUGE_VAL;
    void add(double at) {
        least = std::min(least, at);
        greatest = std::max(greatest, at);
    }
};

struct Box {
    Range x, y;
};

std::vector<GeoPoint> circle_about(const SitePosition& site, double radius_m) {
    const SiteFrame frame(site.latitude_deg, site.longitude_deg);
    std::vector<GeoPoint> circle;
    circle.reserve(circle_points);
    for (int i = 0; i < circle_points; ++i)
        circle.push_back(frame.to_geo({360.0 * i / circle_points, radius_m}));
    return circle;
}

// Returns true if the pole is within `radius_m` of the site.
bool holds_pole(const SitePosition& site, double radius_m, double pole_deg) {
    const SiteFrame frame(site.latitude_deg, site.longitude_deg);
    return frame.to_polar({pole_deg, site.longitude_deg}).arc_m < radius_m;
}

// Returns the ranges for a grid in degrees, where rows are latitudes and columns are longitudes.
// The columns may extend beyond both ends of the domain.
Box box_in_degrees(const GridSpec& domain, const SitePosition& site, double radius_m) {
    const GridProjection projection(domain);
    const double site_x = projection.to_column({site.latitude_deg, site.longitude_deg}).x;
    Box box;
    for (const GeoPoint& point : circle_about(site, radius_m)) {
        const MaskedTraps masked;
        const double east_deg =
            GeographicLib::Math::AngDiff(site.longitude_deg, point.longitude_deg);
        box.x.add(site_x + east_deg / domain.spacing_deg);
        box.y.add(projection.to_column(point).y);
    }
    for (const double pole_deg : {-90.0, 90.0}) {
        if (!holds_pole(site, radius_m, pole_deg)) continue;
        box.y.add(projection.to_column({pole_deg, 0}).y);
        box.x = {-HUGE_VAL, HUGE_VAL};
    }
    return box;
}

// Returns the ranges for a grid in a plane, or none if the plane is torn within the circle.
std::optional<Box> box_in_plane(const GridSpec& domain, const SitePosition& site, double radius_m) {
    const MaskedTraps masked;  // a projection may give infinity for a place that it does not show
    const GridProjection projection(domain);
    const double step_m = 2 * 3.15 * radius_m / circle_points;
    const double longest = largest_stretch * step_m / domain.spacing_m;
    const std::vector<GeoPoint> circle = circle_about(site, radius_m);
    ColumnPoint last = projection.to_column(circle.back());
    Box box;
    for (const GeoPoint& point : circle) {
        const ColumnPoint at = projection.to_column(point);
        if (!(std::hypot(at.x - last.x, at.y - last.y) <= longest)) return std::nullopt;
        box.x.add(at.x);
        box.y.add(at.y);
        last = at;
    }
    // The box around the projected circle also holds the inside of the circle, unless the
    // projection turns the circle inside out.
    const ColumnPoint middle = projection.to_column({site.latitude_deg, site.longitude_deg});
    const bool inside = is_within(middle.x, box.x.least, box.x.greatest) &&
                        is_within(middle.y, box.y.least, box.y.greatest);
    if (!inside) return std::nullopt;
    return box;
}

// The columns from `first` to before `end`. They are whole bricks.
struct Span {
    int first = 0;
    int end = 0;
};
Span whole_bricks(const Range& range, int count) {
    const double first = std::clamp(std::floor(range.least), 0.0, 1.0 * count);
    const double end = std::clamp(std::ceil(range.greatest) + 1, 0.0, 1.0 * count);
    if (!(first < end)) return {};
    const int first_brick = static_cast<int>(first) / brick_edge;
    return {first_brick * brick_edge,
            std::min(count, bricks_along(static_cast<int>(end)) * brick_edge)};
}

// Returns the whole bricks around a range. In a grid in degrees, a column one turn to the west or
// to the east shows the same places.
Span whole_bricks_around(const Range& range, const GridSpec& domain) {
    const double turn = 360 / domain.spacing_deg;
    Span all;
    for (const double by : {-turn, 0.0, turn}) {
        const Span here = whole_bricks({range.least + by, range.greatest + by}, domain.nx);
        if (here.first == here.end) continue;
        if (all.first == all.end) {
            all = here;
        } else {
            all = {std::min(all.first, here.first), std::max(all.end, here.end)};
        }
    }
    return all;
}

}  // namespace

GridSpec window_spec(const GridSpec& domain, const GridWindow& window) {
    GridSpec spec = domain;
    spec.nx = window.nx;
    spec.ny = window.ny;
    // Column 0 of the window is column first_x of the domain, so the center moves by first_x
    // columns. In double this is exact for numbers of this size, halves included.
    spec.offset_x_cells = 0.5 * (window.nx - 1) - (domain.center_x() - window.first_x);
    spec.offset_y_cells = 0.5 * (window.ny - 1) - (domain.center_y() - window.first_y);
    return spec;
}

std::optional<GridWindow> window_of(const GridSpec& domain, const GridSpec& spec) {
    const double first_x = domain.center_x() - spec.center_x();
    const double first_y = domain.center_y() - spec.center_y();
    const bool inside = is_within(first_x, 0.0, 1.0 * domain.nx - spec.nx) &&
                        is_within(first_y, 0.0, 1.0 * domain.ny - spec.ny);
    if (!inside) return std::nullopt;
    const GridWindow window{static_cast<int>(first_x), static_cast<int>(first_y), spec.nx, spec.ny};
    if (!(window_spec(domain, window) == spec)) return std::nullopt;
    return window;
}

bool is_whole_bricks(const GridSpec& domain, const GridWindow& window) {
    const auto whole = [](int first, int end, int count) {
        return first % brick_edge == 0 && (end % brick_edge == 0 || end == count);
    };
    return whole(window.first_x, window.end_x(), domain.nx) &&
           whole(window.first_y, window.end_y(), domain.ny);
}

std::optional<GridWindow> site_window(const GridSpec& domain, const SitePosition& site,
                                      double reach_m) {
    const double radius_m = reach_m * bulge;
    Span x{0, domain.nx};
    Span y{0, domain.ny};
    if (domain.in_degrees()) {
        const Box box = box_in_degrees(domain, site, radius_m);
        x = whole_bricks_around(box.x, domain);
        y = whole_bricks(box.y, domain.ny);
    } else if (const auto box = box_in_plane(domain, site, radius_m)) {
        x = whole_bricks(box->x, domain.nx);
        y = whole_bricks(box->y, domain.ny);
    }
    if (x.first == x.end || y.first == y.end) return std::nullopt;
    return GridWindow{x.first, y.first, x.end - x.first, y.end - y.first};
}

}  // namespace stormcellar::grid
