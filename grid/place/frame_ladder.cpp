#include "stormcellar/grid/frame_ladder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/degree.h"
#include "grid/frame/sphere_frame.h"
#include "grid/place/frame_table.h"
#include "stormcellar/grid/beam_geometry.h"
#include "stormcellar/grid/projection.h"

namespace stormcellar::grid {
namespace {

constexpr double geodesic_error_m = 1e-6;
constexpr double half_meridian_m = 20003931.5;  // of WGS84; no two points are farther apart
constexpr double quarter_meridian_m = 10001965.7;

// The shares by which a length on the sphere is greater than on the ellipsoid, along the meridian
// and along the parallel.
struct ScaleError {
    double north = 0;
    double east = 0;
};
ScaleError scale_error(double latitude_deg) {
    constexpr double e2 = wgs84_flattening * (2 - wgs84_flattening);
    const double sine = std::sin(latitude_deg * degree);
    const double w2 = 1 - e2 * sine * sine;
    const double prime_vertical_m = wgs84_semi_major_m / std::sqrt(w2);
    return {SphereFrame::radius_m / (prime_vertical_m * (1 - e2) / w2) - 1,
            SphereFrame::radius_m / prime_vertical_m - 1};
}

// Returns the largest error of scale, in any direction, between two latitudes. Both errors fall
// from the equator to the poles, so they are extreme at the two ends.
double largest_scale_error(double latitude_deg, double width_deg) {
    const double middle_deg = std::abs(latitude_deg);
    const ScaleError low = scale_error(std::max(0.0, middle_deg - width_deg));
    const ScaleError high = scale_error(std::min(90.0, middle_deg + width_deg));
    return std::max(
        {std::abs(low.north), std::abs(low.east), std::abs(high.north), std::abs(high.east)});
}

// Returns columns along the border of a grid, including its corners, at most about 256 on each
// side.
std::vector<ColumnPoint> border_of(const GridSpec& spec) {
    std::vector<ColumnPoint> border;
    const auto along = [](int count, auto add) {
        const int pieces = std::min(count - 1, 256);
        for (int i = 0; i <= pieces; ++i)
            add(pieces == 0 ? 0.0 : static_cast<double>(count - 1) * i / pieces);
    };
    along(spec.nx, [&](double x) { border.push_back({x, 0}); });
    along(spec.ny, [&](double y) { border.push_back({spec.nx - 1.0, y}); });
    along(spec.nx, [&](double x) { border.push_back({spec.nx - 1.0 - x, spec.ny - 1.0}); });
    along(spec.ny, [&](double y) { border.push_back({0, spec.ny - 1.0 - y}); });
    return border;
}

// Returns true if the grid holds the site's antipode. No other point inside a region can be a
// maximum of the arc.
bool holds_antipode(const SitePosition& site, const GridSpec& spec,
                    const GridProjection& projection) {
    const ColumnPoint at = projection.to_column({-site.latitude_deg, site.longitude_deg + 180});
    return at.x > -1 && at.x < spec.nx && at.y > -1 && at.y < spec.ny;
}

}  // namespace

std::string_view frame_kind_name(FrameKind kind) {
    constexpr std::array<std::string_view, 3> names = {"sphere", "table", "geodesic"};
    return names[static_cast<std::size_t>(kind)];
}

bool is_centered_at(const SitePosition& site, const GridSpec& spec) {
    return facts_of(spec.projection).is_polar && site.latitude_deg == spec.center_latitude_deg &&
           site.longitude_deg == spec.center_longitude_deg;
}

double reach_m(const SitePosition& site, const GridSpec& spec) {
    if (is_centered_at(site, spec)) {
        const double x_m = std::max(-spec.x_m(0), spec.x_m(spec.nx - 1));
        const double y_m = std::max(-spec.y_m(0), spec.y_m(spec.ny - 1));
        return std::min(std::hypot(x_m, y_m), half_meridian_m);
    }
    const GridProjection projection(spec);
    if (holds_antipode(site, spec, projection)) return half_meridian_m;
    const SiteFrame frame(site.latitude_deg, site.longitude_deg);
    double farthest_m = 0;
    double widest_gap_m = 0;
    GeoPoint last;
    bool first = true;
    for (const ColumnPoint column : border_of(spec)) {
        const GeoPoint point = projection.to_geo(column);
        farthest_m = std::max(farthest_m, frame.to_polar(point).arc_m);
        if (!first) {
            const SiteFrame here(last.latitude_deg, last.longitude_deg);
            widest_gap_m = std::max(widest_gap_m, here.to_polar(point).arc_m);
        }
        last = point;
        first = false;
    }
    // Every column of the border is at most half a gap from a column whose arc is computed. The
    // extra tenth is for a border that is curved between these columns.
    return std::min(farthest_m + 0.55 * widest_gap_m, half_meridian_m);
}

double storage_error_bound_m(double reach_m) noexcept {
    // The error of rounding to a float, for an azimuth below 360 and for the arc.
    constexpr double azimuth_rad = 0x1p-16 * degree;
    const double arc_m = std::ldexp(1.0, std::ilogb(std::max(reach_m, 1e-30)) - 24);
    return std::hypot(reach_m * azimuth_rad, arc_m);
}

// Consider a step ds along a geodesic from the site. Its image on the sphere is stretched by (1 +
// north) along the meridian and by (1 + east) along the parallel, both at the latitude of the step.
// Nothing else turns the image away from a great circle, because latitude and azimuth change alike
// on both. So the larger of the two errors, integrated along the geodesic, bounds the distance by
// which the end of the image is off. In the equidistant plane, this distance is multiplied by theta
// / sin(theta), where theta is the angle of the arc. The bound adds 1 % for products of errors.
double sphere_error_bound_m(double site_latitude_deg, double reach_m) noexcept {
    if (!(reach_m > 0)) return 0;
    // Two points of the disc are at most its width apart.
    if (reach_m > quarter_meridian_m) return 2.01 * reach_m;
    constexpr int steps = 64;
    constexpr double shortest_degree_m = 110574;  // length of a degree of latitude at the equator
    double sum = 0;
    for (int step = 1; step <= steps; ++step) {
        const double width_deg = reach_m * step / steps / shortest_degree_m;
        sum += largest_scale_error(site_latitude_deg, width_deg);
    }
    const double theta = reach_m / SphereFrame::radius_m;
    return 1.01 * sum / steps * reach_m * theta / std::sin(theta);
}

double frame_error_bound_m(FrameKind kind, double site_latitude_deg, double reach_m) noexcept {
    const double storage_m = storage_error_bound_m(reach_m);
    switch (kind) {
        case FrameKind::sphere:
            return storage_m + sphere_error_bound_m(site_latitude_deg, reach_m);
        case FrameKind::table:
            return storage_m + frame_table_error_m;
        case FrameKind::geodesic:
            break;
    }
    return storage_m + geodesic_error_m;
}

double frame_error_bound_m(FrameKind kind, const SitePosition& site, const GridSpec& spec) {
    const double farthest_m = reach_m(site, spec);
    if (is_centered_at(site, spec)) return storage_error_bound_m(farthest_m);
    return frame_error_bound_m(kind, site.latitude_deg, farthest_m);
}

}  // namespace stormcellar::grid
