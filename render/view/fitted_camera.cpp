#include "render/view/fitted_camera.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/degree.h"
#include "stormcellar/render/view_geometry.h"

namespace stormcellar::render {
namespace {

constexpr double least_area_km2 = 60;  // anything smaller is only specks
constexpr double range_share = 0.02;   // of the columns, is left out at each end of the region
constexpr double wider_share = 0.12, wider_m = 5e3;
constexpr double least_half_m = 15e3;  // of the region, in each direction
constexpr double filled_share = 0.84;
constexpr double fitted_field_of_view_deg = 40;
constexpr double usual_azimuth_deg = 180, farthest_turn_deg = 45;
// A region with this ratio of length to width, or with a larger ratio, is a line.
constexpr double long_ratio = 1.8;
constexpr double least_top_m = 2e3;
constexpr double sun_from_camera_deg = 65, sun_height_deg = 40;
constexpr double earth_diameter_m = 2 * 6371e3;
constexpr std::size_t all_columns = EchoOutline::all_columns;

double scalar_product(const Vec3& a, const Vec3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// The region that is shown, in meters from the grid's middle.
struct Region {
    double west_m = 0, east_m = 0, south_m = 0, north_m = 0, top_m = 0;
    std::size_t of_threshold = all_columns;  // the columns of the region reach this threshold

    [[nodiscard]] double x_m() const { return 0.5 * (west_m + east_m); }
    [[nodiscard]] double y_m() const { return 0.5 * (south_m + north_m); }
    [[nodiscard]] double width_m() const { return east_m - west_m; }
    [[nodiscard]] double height_m() const { return north_m - south_m; }
    [[nodiscard]] double side_m() const { return std::hypot(width_m(), height_m()) / std::sqrt(2); }
};

template <class Each>
void for_each_tile(const EchoOutline& outline, Each each) {
    for (int x = 0; x < outline.across(); ++x) {
        for (int y = 0; y < outline.up(); ++y)
            each(x, y, outline.tile(x, y));
    }
}

// Returns the highest threshold that enough columns reach, or all columns if no threshold is
// reached. Returns none if there is no value at all.
std::optional<std::size_t> threshold_shown(const EchoOutline& outline) {
    const auto columns = outline.columns();
    for (std::size_t k = 0; k < all_columns; ++k) {
        if (k == 1) continue;  // 35 dBZ only adds columns to a region of 40 dBZ
        if (columns[k] * outline.column_km2() >= least_area_km2) return k;
    }
    if (!(columns[all_columns] > 0)) return std::nullopt;
    return all_columns;
}

// Returns the range along one axis that holds all columns but a small share.
std::pair<int, int> middle_range(const std::vector<double>& counts) {
    double all = 0;
    for (const double count : counts)
        all += count;
    const auto at = [&](double share) {
        double below = 0;
        for (std::size_t i = 0; i < counts.size(); ++i) {
            below += counts[i];
            if (below > share * all) return static_cast<int>(i);
        }
        return static_cast<int>(counts.size()) - 1;
    };
    return {at(range_share), at(1 - range_share)};
}

void widen(double& low_m, double& high_m, double least_m, double most_m) {
    const double middle = 0.5 * (low_m + high_m);
    const double half =
        std::max(0.5 * (high_m - low_m) * (1 + 2 * wider_share) + wider_m, least_half_m);
    low_m = std::max(middle - half, least_m);
    high_m = std::min(middle + half, most_m);
}

std::optional<Region> region_of(const EchoOutline& outline) {
    if (outline.empty()) return std::nullopt;
    const auto shown = threshold_shown(outline);
    if (!shown) return std::nullopt;
    std::vector<double> by_x(static_cast<std::size_t>(outline.across()));
    std::vector<double> by_y(static_cast<std::size_t>(outline.up()));
    for_each_tile(outline, [&](int x, int y, const EchoOutline::Tile& tile) {
        by_x[static_cast<std::size_t>(x)] += tile.columns[*shown];
        by_y[static_cast<std::size_t>(y)] += tile.columns[*shown];
    });
    const auto [first_x, last_x] = middle_range(by_x);
    const auto [first_y, last_y] = middle_range(by_y);
    Region region;
    region.of_threshold = *shown == 0 ? 1 : *shown;
    region.west_m = outline.west_m(first_x);
    region.east_m = outline.west_m(last_x + 1);
    region.south_m = outline.south_m(first_y);
    region.north_m = outline.south_m(last_y + 1);
    widen(region.west_m, region.east_m, outline.west_m(0), outline.west_m(outline.across()));
    widen(region.south_m, region.north_m, outline.south_m(0), outline.south_m(outline.up()));
    return region;
}

struct Column {
    double x_m, y_m, half_m, top_m;
    double weight;
};
std::vector<Column> columns_of(const EchoOutline& outline, const Region& region) {
    std::vector<Column> columns;
    const double half_m = 0.5 * EchoOutline::tile_columns * outline.spec().cell_width_m();
    for_each_tile(outline, [&](int x, int y, const EchoOutline::Tile& tile) {
        const int count = tile.columns[region.of_threshold];
        if (count == 0) return;
        const double x_m = 0.5 * (outline.west_m(x) + outline.west_m(x + 1));
        const double y_m = 0.5 * (outline.south_m(y) + outline.south_m(y + 1));
        if (x_m < region.west_m || x_m > region.east_m || y_m < region.south_m ||
            y_m > region.north_m) {
            return;
        }
        columns.push_back(
            {x_m, y_m, half_m, static_cast<double>(tile.top_m), static_cast<double>(count)});
    });
    return columns;
}

// Returns a height that is above the tops of nearly all columns.
double usual_top_m(std::vector<Column> columns) {
    if (columns.empty()) return least_top_m;
    const auto place = static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(columns.size() - 1));
    std::nth_element(columns.begin(), columns.begin() + place, columns.end(),
                     [](const Column& a, const Column& b) { return a.top_m < b.top_m; });
    return std::max(columns[static_cast<std::size_t>(place)].top_m, least_top_m);
}

// Returns the direction, near south, from which the camera sees the long side of the columns.
double azimuth_for(const std::vector<Column>& columns) {
    double sum = 0, x = 0, y = 0;
    for (const Column& c : columns) {
        sum += c.weight;
        x += c.weight * c.x_m;
        y += c.weight * c.y_m;
    }
    if (!(sum > 0)) return usual_azimuth_deg;
    double xx = 0, yy = 0, xy = 0;
    for (const Column& c : columns) {
        const double dx = c.x_m - x / sum, dy = c.y_m - y / sum;
        xx += c.weight * dx * dx;
        yy += c.weight * dy * dy;
        xy += c.weight * dx * dy;
    }
    const double middle = 0.5 * (xx + yy);
    const double apart = std::hypot(0.5 * (xx - yy), xy);
    if (!(middle + apart > long_ratio * long_ratio * (middle - apart))) return usual_azimuth_deg;
    // The angle of the long axis, counterclockwise from east. The camera is on the right side of
    // it.
    const double axis_deg = 0.5 * std::atan2(xy, 0.5 * (xx - yy)) / degree;
    const double turn_deg = std::clamp(-axis_deg, -farthest_turn_deg, farthest_turn_deg);
    return usual_azimuth_deg + 5 * std::round(turn_deg / 5);
}

// Returns 0 for a region as small as a storm, and 1 for a region as wide as a radar sees.
double wideness(const Region& region) {
    constexpr double storm_m = 110e3, wide_m = 380e3;
    return std::clamp(std::log(region.side_m() / storm_m) / std::log(wide_m / storm_m), 0.0, 1.0);
}

double exaggeration_for(const Region& region) {
    const double wanted = 0.1 * region.side_m() / region.top_m;
    return 0.5 * std::round(2 * std::clamp(wanted, 2.0, 5.0));
}

// Returns the factor of the opacity. With the usual curve of opacity, weak echo is a thin veil.
// Weak echo is drawn more opaque if nothing else is shown; so is a wide region. Clear air has its
// own colors, which are opaque enough.
double opacity_for(const Region& region) {
    constexpr std::array<double, all_columns + 1> factors = {1, 1, 2, 4, 1, 1};
    const double wide = 1 + 0.8 * wideness(region);
    return std::round(10 * factors[region.of_threshold] * wide) / 10;
}

double fall_m(bool curved_earth, double x_m, double y_m) {
    return curved_earth ? (x_m * x_m + y_m * y_m) / earth_diameter_m : 0;
}

// The directions along which a camera looks, and the extent of its picture.
struct Looks {
    Vec3 right{}, up{}, forward{};
    double across = 0, upright = 0;  // tangents of half the angles that the echo fills

    Looks(const Camera& camera, int width, int height) {
        const double azimuth = camera.azimuth_deg * degree, tilt = camera.tilt_deg * degree;
        forward = {-std::sin(tilt) * std::sin(azimuth), -std::sin(tilt) * std::cos(azimuth),
                   -std::cos(tilt)};
        right = {-std::cos(azimuth), std::sin(azimuth), 0};
        up = {-std::cos(tilt) * std::sin(azimuth), -std::cos(tilt) * std::cos(azimuth),
              std::sin(tilt)};
        across = filled_share * std::tan(0.5 * camera.field_of_view_deg * degree) / camera.zoom;
        upright = across * height / width;
    }
};

// Returns the corners of the columns, in drawn space.
std::vector<Vec3> corners_of(const std::vector<Column>& columns, double top_m, double exaggeration,
                             bool curved_earth) {
    std::vector<Vec3> corners;
    for (const Column& c : columns) {
        const double top = std::min(c.top_m, 1.15 * top_m);
        for (const double side : {-1.0, 1.0}) {
            const double x = c.x_m + side * c.half_m, y = c.y_m + side * c.half_m;
            for (const double height : {0.0, top})
                corners.push_back({x, y, (height - fall_m(curved_earth, x, y)) * exaggeration});
        }
    }
    return corners;
}

// Returns the nearest place from which a camera that looks along `looks` has all points in its
// picture. Each edge of the picture is a plane through the camera. Let r, u and f be coordinates to
// the right, up and forward. Then a point is inside the left plane if r - r0 >= -k (f - f0). The
// nearest place has the largest f0 that leaves room between left and right, and between below and
// above.
Vec3 nearest_place(const std::vector<Vec3>& points, const Looks& looks) {
    constexpr double huge = std::numeric_limits<double>::infinity();
    double left = huge, right = -huge, below = huge, above = -huge;
    for (const Vec3& p : points) {
        const double r = scalar_product(p, looks.right), u = scalar_product(p, looks.up);
        const double f = scalar_product(p, looks.forward);
        left = std::min(left, r + looks.across * f);
        right = std::max(right, r - looks.across * f);
        below = std::min(below, u + looks.upright * f);
        above = std::max(above, u - looks.upright * f);
    }
    const double f =
        std::min((left - right) / (2 * looks.across), (below - above) / (2 * looks.upright));
    const double r = 0.5 * (left + right), u = 0.5 * (below + above);
    Vec3 place{};
    for (std::size_t i = 0; i < 3; ++i)
        place[i] = r * looks.right[i] + u * looks.up[i] + f * looks.forward[i];
    return place;
}

// Returns the least distance from the focus for a camera that looks at the focus.
double least_distance(const std::vector<Vec3>& points, const Vec3& focus, const Looks& looks) {
    double distance = 0;
    for (const Vec3& p : points) {
        const Vec3 from = {p[0] - focus[0], p[1] - focus[1], p[2] - focus[2]};
        const double aside = std::max(std::abs(scalar_product(from, looks.right)) / looks.across,
                                      std::abs(scalar_product(from, looks.up)) / looks.upright);
        distance = std::max(distance, aside - scalar_product(from, looks.forward));
    }
    return distance;
}

Eye eye_at(const Vec3& drawn, double exaggeration, bool curved_earth) {
    return {drawn[0], drawn[1], drawn[2] / exaggeration + fall_m(curved_earth, drawn[0], drawn[1])};
}
Vec3 drawn_at(const Eye& eye, double exaggeration, bool curved_earth) {
    return {eye.x_m, eye.y_m,
            (eye.height_m - fall_m(curved_earth, eye.x_m, eye.y_m)) * exaggeration};
}

void place_camera(const std::vector<Vec3>& points, const Region& region, const Scene& scene,
                  int width, int height, bool orbits, FittedView& fitted) {
    const double exaggeration = fitted.vertical_exaggeration;
    const bool curved = scene.curved_earth;
    Camera camera = fitted.camera;
    const Looks looks(camera, width, height);
    Vec3 focus = drawn_at({region.x_m(), region.y_m(), 0.4 * region.top_m}, exaggeration, curved);
    if (!orbits) {
        const Vec3 eye = nearest_place(points, looks);
        const Vec3 to_focus = {focus[0] - eye[0], focus[1] - eye[1], focus[2] - eye[2]};
        fitted.distance_m = scalar_product(to_focus, looks.forward);
        for (std::size_t i = 0; i < 3; ++i)
            focus[i] = eye[i] + fitted.distance_m * looks.forward[i];
        fitted.camera.eye = eye_at(eye, exaggeration, curved);
    } else {
        for (int turn = 0; turn < 360; turn += 15) {
            camera.azimuth_deg = fitted.camera.azimuth_deg + turn;
            fitted.distance_m = std::max(
                fitted.distance_m, least_distance(points, focus, Looks(camera, width, height)));
        }
        Vec3 eye = focus;
        for (std::size_t i = 0; i < 3; ++i)
            eye[i] -= fitted.distance_m * looks.forward[i];
        fitted.camera.eye = eye_at(eye, exaggeration, curved);
    }
    fitted.focus = eye_at(focus, exaggeration, curved);
}

}  // namespace

FittedView fit_view(const EchoOutline& outline, const Scene& scene, int width, int height,
                    const FitParts& parts, bool orbits) {
    FittedView fitted;
    fitted.camera = scene.camera;
    fitted.vertical_exaggeration = scene.vertical_exaggeration;
    fitted.opacity = scene.opacity;
    fitted.sun_azimuth_deg = scene.light.sun_azimuth_deg;
    fitted.sun_elevation_deg = scene.light.sun_elevation_deg;
    if (parts.field_of_view) fitted.camera.field_of_view_deg = fitted_field_of_view_deg;
    const auto choose_sun = [&] {
        if (!parts.sun) return;
        fitted.sun_azimuth_deg =
            std::fmod(fitted.camera.azimuth_deg + sun_from_camera_deg + 360, 360);
        fitted.sun_elevation_deg = sun_height_deg;
    };
    auto region = region_of(outline);
    if (!region) {
        choose_sun();
        return fitted;
    }
    fitted.has_echo = true;
    const std::vector<Column> columns = columns_of(outline, *region);
    region->top_m = usual_top_m(columns);
    if (parts.azimuth) fitted.camera.azimuth_deg = azimuth_for(columns);
    if (parts.tilt) fitted.camera.tilt_deg = std::round(70 - 18 * wideness(*region));
    if (parts.exaggeration) fitted.vertical_exaggeration = exaggeration_for(*region);
    if (parts.opacity) fitted.opacity = opacity_for(*region);
    choose_sun();
    if (parts.place && !fitted.camera.eye && fitted.camera.field_of_view_deg > 0) {
        const auto points =
            corners_of(columns, region->top_m, fitted.vertical_exaggeration, scene.curved_earth);
        place_camera(points, *region, scene, width, height, orbits, fitted);
    }
    return fitted;
}

Camera turned(const FittedView& fitted, double by_deg, bool curved_earth) {
    Camera camera = fitted.camera;
    camera.azimuth_deg += by_deg;
    if (!(fitted.distance_m > 0)) return camera;
    const Looks looks(camera, 1, 1);
    Vec3 eye = drawn_at(fitted.focus, fitted.vertical_exaggeration, curved_earth);
    for (std::size_t i = 0; i < 3; ++i)
        eye[i] -= fitted.distance_m * looks.forward[i];
    camera.eye = eye_at(eye, fitted.vertical_exaggeration, curved_earth);
    return camera;
}

void apply(const FittedView& fitted, Scene& scene) {
    scene.camera = fitted.camera;
    scene.vertical_exaggeration = fitted.vertical_exaggeration;
    scene.opacity = fitted.opacity;
    scene.light.sun_azimuth_deg = fitted.sun_azimuth_deg;
    scene.light.sun_elevation_deg = fitted.sun_elevation_deg;
}

}  // namespace stormcellar::render
