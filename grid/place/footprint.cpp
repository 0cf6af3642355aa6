#include "grid/place/footprint.h"

#include <algorithm>
#include <cmath>

#include "base/degree.h"

namespace stormcellar::grid {
namespace {

struct Vector {
    double east_m = 0;
    double north_m = 0;
};

Vector place_of(const ColumnGeometry& geometry, int ix, int iy) {
    const ColumnPlace& at = geometry.row(iy)[static_cast<std::size_t>(ix)];
    const double azimuth = static_cast<double>(at.azimuth_deg) * degree;
    const auto arc_m = static_cast<double>(at.arc_m);
    return {arc_m * std::sin(azimuth), arc_m * std::cos(azimuth)};
}

// Returns the step from a column to the next. At the edge of the spec, returns the step from the
// previous column.
Vector step(const ColumnGeometry& geometry, int ix, int iy, int dx, int dy) {
    const GridSpec& spec = geometry.spec();
    const int from_x = std::max(0, ix - dx);
    const int from_y = std::max(0, iy - dy);
    const int to_x = std::min(spec.nx - 1, ix + dx);
    const int to_y = std::min(spec.ny - 1, iy + dy);
    const int steps = to_x - from_x + to_y - from_y;
    const Vector from = place_of(geometry, from_x, from_y);
    const Vector to = place_of(geometry, to_x, to_y);
    return {(to.east_m - from.east_m) / steps, (to.north_m - from.north_m) / steps};
}

}  // namespace

Footprint footprint_of(const ColumnGeometry& geometry, int ix, int iy) {
    const GridSpec& spec = geometry.spec();
    Vector x{spec.cell_width_m(), 0};
    Vector y{0, spec.cell_height_m()};
    if (spec.nx > 1) x = step(geometry, ix, iy, 1, 0);
    if (spec.ny > 1) y = step(geometry, ix, iy, 0, 1);
    if (spec.nx == 1 && spec.ny > 1) x = {y.north_m, -y.east_m};
    if (spec.ny == 1 && spec.nx > 1) y = {-x.north_m, x.east_m};

    const ColumnPlace& at = geometry.row(iy)[static_cast<std::size_t>(ix)];
    const double sine = std::sin(static_cast<double>(at.azimuth_deg) * degree);
    const double cosine = std::cos(static_cast<double>(at.azimuth_deg) * degree);
    // u and v are the rows of the inverse of a matrix. Its columns are x and y, in east and north.
    const double area_m2 = x.east_m * y.north_m - x.north_m * y.east_m;
    const double u_east = y.north_m / area_m2;
    const double u_north = -y.east_m / area_m2;
    const double v_east = -x.north_m / area_m2;
    const double v_north = x.east_m / area_m2;
    // Turn u and v from east and north into along (sine, cosine) and across (cosine, -sine).
    Footprint footprint;
    footprint.azimuth_deg = at.azimuth_deg;
    footprint.arc_m = at.arc_m;
    footprint.u_along = static_cast<float>(u_east * sine + u_north * cosine);
    footprint.u_across = static_cast<float>(u_east * cosine - u_north * sine);
    footprint.v_along = static_cast<float>(v_east * sine + v_north * cosine);
    footprint.v_across = static_cast<float>(v_east * cosine - v_north * sine);
    const double one_m = std::hypot(x.east_m + y.east_m, x.north_m + y.north_m) / 2;
    const double other_m = std::hypot(x.east_m - y.east_m, x.north_m - y.north_m) / 2;
    footprint.radius_m = static_cast<float>(std::max(one_m, other_m));
    return footprint;
}

}  // namespace stormcellar::grid
