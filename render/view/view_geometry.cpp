#include "stormcellar/render/view_geometry.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace stormcellar::render {
namespace {

constexpr double margin = 1.04;  // enlarges the box, so that nothing touches the edge
constexpr double single_level_m = 1000;
constexpr double earth_radius_m = 6371e3;
// the nearest depth that a perspective camera sees, as a share of the farthest depth
constexpr double nearest_share = 1e-4;
constexpr double flattest = 1e-6;  // a view that falls by less than this runs along the ground

double dot(const Vec3& a, const Vec3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Vec3 minus(const Vec3& a, const Vec3& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

// Sine and cosine. They are exact at quarter turns, because most views are at quarter turns.
struct Turn {
    double sine, cosine;
};
Turn turn_of(double degrees) {
    const double full = std::fmod(degrees, 360.0);
    const double quarters = std::nearbyint(full / 90.0);
    const double rest = (full - 90.0 * quarters) * std::numbers::pi / 180.0;
    const double s = std::sin(rest);
    const double c = std::cos(rest);
    switch ((static_cast<int>(quarters) % 4 + 4) % 4) {
        case 0:
            return {s, c};
        case 1:
            return {c, -s};
        case 2:
            return {-s, -c};
        default:
            return {-c, s};
    }
}

}  // namespace

Camera aimed(const Camera& camera, double vertical_exaggeration, bool curved_earth) {
    if (!camera.eye || !camera.look_at) return camera;
    const auto drawn_z = [&](const Eye& at) {
        const double drop_m =
            curved_earth ? 0.5 / earth_radius_m * (at.x_m * at.x_m + at.y_m * at.y_m) : 0;
        return (at.height_m - drop_m) * vertical_exaggeration;
    };
    const double east_m = camera.look_at->x_m - camera.eye->x_m;
    const double north_m = camera.look_at->y_m - camera.eye->y_m;
    const double up_m = drawn_z(*camera.look_at) - drawn_z(*camera.eye);
    const double aside_m = std::hypot(east_m, north_m);
    constexpr double degrees = 180 / std::numbers::pi;
    Camera turned = camera;
    if (aside_m > 0 || up_m != 0) turned.tilt_deg = std::atan2(aside_m, -up_m) * degrees;
    if (aside_m > 0) {
        const double azimuth_deg = std::atan2(-east_m, -north_m) * degrees;
        turned.azimuth_deg = azimuth_deg < 0 ? azimuth_deg + 360 : azimuth_deg;
    }
    return turned;
}

HeightRange height_range(const grid::GridSpec& spec) {
    const auto& levels = spec.levels_m;
    if (levels.size() == 1) {
        return {levels[0] - single_level_m / 2, levels[0] + single_level_m / 2};
    }
    const std::size_t last = levels.size() - 1;
    return {levels[0] - (levels[1] - levels[0]) / 2,
            levels[last] + (levels[last] - levels[last - 1]) / 2};
}

ViewGeometry::ViewGeometry(const grid::GridSpec& spec, const Camera& given,
                           double vertical_exaggeration, int width, int height, bool curved_earth)
    : width_(width),
      height_(height),
      exaggeration_(vertical_exaggeration),
      half_x_m_(0.5 * spec.nx * spec.cell_width_m()),
      half_y_m_(0.5 * spec.ny * spec.cell_height_m()),
      bottom_m_(height_range(spec).bottom_m),
      top_m_(height_range(spec).top_m),
      ground_m_(std::min(0.0, bottom_m_)),
      drop_per_m2_(curved_earth ? 0.5 / earth_radius_m : 0) {
    const Camera camera = aimed(given, vertical_exaggeration, curved_earth);
    const Turn azimuth = turn_of(camera.azimuth_deg);
    const Turn tilt = turn_of(camera.tilt_deg);
    forward_ = {-tilt.sine * azimuth.sine, -tilt.sine * azimuth.cosine, -tilt.cosine};
    right_ = {-azimuth.cosine, azimuth.sine, 0};
    up_ = {-tilt.cosine * azimuth.sine, -tilt.cosine * azimuth.cosine, tilt.sine};
    const double low = ground_m_ - drop_m(half_x_m_, half_y_m_);
    middle_ = {0, 0, 0.5 * (low + top_m_) * exaggeration_};
    eye_ = middle_;
    if (camera.field_of_view_deg > 0) {
        place_eye(camera);
    } else {
        fit_picture(camera);
    }
    if (camera.look_at && !camera.eye) look_at(*camera.look_at);
    find_depths();
}

// Returns the corners of the box from a height upward, in drawn space.
std::array<Vec3, 8> ViewGeometry::corners(double low_m) const {
    std::array<Vec3, 8> all{};
    for (std::size_t i = 0; i < all.size(); ++i) {
        all[i] = {(i & 1) != 0 ? half_x_m_ : -half_x_m_, (i & 2) != 0 ? half_y_m_ : -half_y_m_,
                  ((i & 4) != 0 ? top_m_ : low_m) * exaggeration_};
    }
    return all;
}

void ViewGeometry::fit_picture(const Camera& camera) {
    double across = 0, upright = 0;
    for (const Vec3& corner : corners(ground_m_ - drop_m(half_x_m_, half_y_m_))) {
        across = std::max(across, std::abs(dot(minus(corner, middle_), right_)));
        upright = std::max(upright, std::abs(dot(minus(corner, middle_), up_)));
    }
    metres_per_pixel_ = margin * std::max(2 * across / width_, 2 * upright / height_) / camera.zoom;
}

// Places the camera. The field of view is that of zoom 1. A camera without an `eye` moves back
// until it sees the whole box.
void ViewGeometry::place_eye(const Camera& camera) {
    const double half_angle = 0.5 * camera.field_of_view_deg * std::numbers::pi / 180;
    const double focal = 0.5 * width_ / std::tan(half_angle);
    focal_pixels_ = focal * camera.zoom;
    if (camera.eye) {
        eye_ = {camera.eye->x_m, camera.eye->y_m,
                (camera.eye->height_m - drop_m(camera.eye->x_m, camera.eye->y_m)) * exaggeration_};
    } else {
        double back = 0;
        for (const Vec3& corner : corners(ground_m_ - drop_m(half_x_m_, half_y_m_))) {
            const Vec3 from_middle = minus(corner, middle_);
            const double depth = dot(from_middle, forward_);
            const double aside = std::abs(dot(from_middle, right_)) / (0.5 * width_);
            const double upright = std::abs(dot(from_middle, up_)) / (0.5 * height_);
            back = std::max(back, margin * focal * std::max(aside, upright) - depth);
        }
        for (std::size_t i = 0; i < 3; ++i)
            eye_[i] = middle_[i] - back * forward_[i];
    }
    const double to_middle = dot(minus(middle_, eye_), forward_);
    metres_per_pixel_ = std::max(to_middle, half_x_m_ * 1e-3) / focal_pixels_;
}

// Moves the camera sideways, so that it sees the point where it saw the middle of the box.
void ViewGeometry::look_at(const Eye& point) {
    const Vec3 drawn = {point.x_m, point.y_m,
                        (point.height_m - drop_m(point.x_m, point.y_m)) * exaggeration_};
    for (std::size_t i = 0; i < 3; ++i)
        eye_[i] += drawn[i] - middle_[i];
}

void ViewGeometry::find_depths() {
    near_m_ = std::numeric_limits<double>::infinity();
    far_m_ = -near_m_;
    for (const Vec3& corner : corners(bottom_m_ - drop_m(half_x_m_, half_y_m_))) {
        const double depth = depth_of(corner);
        near_m_ = std::min(near_m_, depth);
        far_m_ = std::max(far_m_, depth);
    }
    if (!is_perspective()) return;
    const double nearest = nearest_share * std::max(std::abs(near_m_), std::abs(far_m_));
    near_m_ = std::max(near_m_, nearest);
    far_m_ = std::max(far_m_, near_m_ + nearest);
}

double ViewGeometry::depth_of(const Vec3& drawn) const {
    return dot(minus(drawn, eye_), forward_);
}

Pixel ViewGeometry::project(double x_m, double y_m, double height_m) const {
    return project({x_m, y_m, (height_m - drop_m(x_m, y_m)) * exaggeration_});
}

Pixel ViewGeometry::project(const Vec3& drawn) const {
    const Vec3 p = minus(drawn, eye_);
    double scale = 1 / metres_per_pixel_;
    if (is_perspective()) {
        const double depth = dot(p, forward_);
        if (!(depth > 0)) {
            constexpr double nan = std::numeric_limits<double>::quiet_NaN();
            return {nan, nan};
        }
        scale = focal_pixels_ / depth;
    }
    return {0.5 * width_ + dot(p, right_) * scale, 0.5 * height_ - dot(p, up_) * scale};
}

Vec3 ViewGeometry::along(Pixel pixel) const {
    if (!is_perspective()) return forward_;
    const double a = (pixel.x - 0.5 * width_) / focal_pixels_;
    const double b = (0.5 * height_ - pixel.y) / focal_pixels_;
    Vec3 direction{};
    for (std::size_t i = 0; i < 3; ++i)
        direction[i] = forward_[i] + a * right_[i] + b * up_[i];
    return direction;
}

Vec3 ViewGeometry::point(Pixel pixel, double depth_m) const {
    Vec3 p = eye_;
    const Vec3 direction = along(pixel);
    const double a = is_perspective() ? 0 : (pixel.x - 0.5 * width_) * metres_per_pixel_;
    const double b = is_perspective() ? 0 : (0.5 * height_ - pixel.y) * metres_per_pixel_;
    for (std::size_t i = 0; i < 3; ++i)
        p[i] += a * right_[i] + b * up_[i] + depth_m * direction[i];
    return p;
}

// The height of the ray above the ground is c d^2 + b d + a, where d is the depth. The ground is at
// the first root at which the height falls.
std::optional<GroundPoint> ViewGeometry::ground(Pixel pixel) const {
    const Vec3 start = point(pixel, 0);
    const Vec3 step = along(pixel);
    const double curve = drop_per_m2_ * exaggeration_;
    const double a =
        start[2] - ground_m_ * exaggeration_ + curve * (start[0] * start[0] + start[1] * start[1]);
    const double b = step[2] + 2 * curve * (start[0] * step[0] + start[1] * step[1]);
    const double c = curve * (step[0] * step[0] + step[1] * step[1]);
    double depth = 0;
    if (c > 0) {
        const double inside = b * b - 4 * a * c;
        if (!(inside > 0)) return std::nullopt;
        // Compute the smaller root in a form that does not subtract nearly equal numbers.
        const double root = std::sqrt(inside);
        depth = b < 0 ? 2 * a / (root - b) : -(b + root) / (2 * c);
    } else {
        if (!(b < -flattest)) return std::nullopt;
        depth = -a / b;
    }
    if (is_perspective() && !(depth > 0)) return std::nullopt;
    return GroundPoint{start[0] + depth * step[0], start[1] + depth * step[1]};
}

void ViewGeometry::ground_of_row(int y, GroundRow& row) const {
    const auto width = static_cast<std::size_t>(width_);
    row.x_m.resize(width);
    row.y_m.resize(width);
    const Pixel first = {0.5, y + 0.5};
    if (drop_per_m2_ == 0) return flat_ground_of_row(first, row);
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    for (std::size_t x = 0; x < width; ++x) {
        const auto at =
            ground({static_cast<double>(x) + 0.5, first.y}).value_or(GroundPoint{nan, nan});
        row.x_m[x] = at.x_m;
        row.y_m[x] = at.y_m;
    }
}

// Uses the fact that a row of pixels is level, because right() is level. So all rays of the row
// fall alike, and meet a flat ground at one depth.
void ViewGeometry::flat_ground_of_row(Pixel first, GroundRow& row) const {
    const double fall = along(first)[2];
    const double depth = -(point(first, 0)[2] - ground_m_ * exaggeration_) / fall;
    if (!(fall < -flattest) || (is_perspective() && !(depth > 0))) {
        constexpr double nan = std::numeric_limits<double>::quiet_NaN();
        std::fill(row.x_m.begin(), row.x_m.end(), nan);
        std::fill(row.y_m.begin(), row.y_m.end(), nan);
        return;
    }
    const auto fill = [&](std::vector<double>& to, std::size_t axis) {
        const double right = right_[axis];
        if (is_perspective()) {
            const double b = (0.5 * height_ - first.y) / focal_pixels_;
            for (std::size_t x = 0; x < to.size(); ++x) {
                const double a = (static_cast<int>(x) + 0.5 - 0.5 * width_) / focal_pixels_;
                to[x] = eye_[axis] + depth * (forward_[axis] + a * right + b * up_[axis]);
            }
            return;
        }
        const double up = (0.5 * height_ - first.y) * metres_per_pixel_ * up_[axis];
        const double ahead = depth * forward_[axis];
        for (std::size_t x = 0; x < to.size(); ++x) {
            const double a = (static_cast<int>(x) + 0.5 - 0.5 * width_) * metres_per_pixel_;
            to[x] = eye_[axis] + (a * right + up) + ahead;
        }
    };
    fill(row.x_m, 0);
    fill(row.y_m, 1);
}

}  // namespace stormcellar::render
