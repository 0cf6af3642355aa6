#include "render/view_geometry.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stormcellar::render {
namespace {

constexpr double margin = 1.04;  // of the box in the picture, so that nothing touches the edge
constexpr double single_level_m = 1000;

double dot(const Vec3& a, const Vec3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// Sine and cosine that are exact at the quarter turns, where views are asked for most often.
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

HeightRange height_range(const grid::GridSpec& spec) {
    const auto& levels = spec.levels_m;
    if (levels.size() == 1) {
        return {levels[0] - single_level_m / 2, levels[0] + single_level_m / 2};
    }
    const std::size_t last = levels.size() - 1;
    return {levels[0] - (levels[1] - levels[0]) / 2,
            levels[last] + (levels[last] - levels[last - 1]) / 2};
}

ViewGeometry::ViewGeometry(const grid::GridSpec& spec, const Camera& camera,
                           double vertical_exaggeration, int width, int height)
    : width_(width),
      height_(height),
      exaggeration_(vertical_exaggeration),
      half_x_m_(0.5 * spec.nx * spec.cell_width_m()),
      half_y_m_(0.5 * spec.ny * spec.cell_height_m()),
      bottom_m_(height_range(spec).bottom_m),
      top_m_(height_range(spec).top_m),
      ground_m_(std::min(0.0, bottom_m_)) {
    const Turn azimuth = turn_of(camera.azimuth_deg);
    const Turn tilt = turn_of(camera.tilt_deg);
    forward_ = {-tilt.sine * azimuth.sine, -tilt.sine * azimuth.cosine, -tilt.cosine};
    right_ = {-azimuth.cosine, azimuth.sine, 0};
    up_ = {-tilt.cosine * azimuth.sine, -tilt.cosine * azimuth.cosine, tilt.sine};

    const double low = ground_m_ * exaggeration_;
    const double high = top_m_ * exaggeration_;
    middle_ = {0, 0, 0.5 * (low + high)};
    const Vec3 half = {half_x_m_, half_y_m_, 0.5 * (high - low)};
    const auto reach = [&half](const Vec3& axis) {
        return std::abs(axis[0]) * half[0] + std::abs(axis[1]) * half[1] +
               std::abs(axis[2]) * half[2];
    };
    metres_per_pixel_ =
        margin * std::max(2 * reach(right_) / width_, 2 * reach(up_) / height_) / camera.zoom;

    const double across = std::abs(forward_[0]) * half_x_m_ + std::abs(forward_[1]) * half_y_m_;
    const double at_bottom = (bottom_m_ * exaggeration_ - middle_[2]) * forward_[2];
    const double at_top = (top_m_ * exaggeration_ - middle_[2]) * forward_[2];
    near_m_ = std::min(at_bottom, at_top) - across;
    far_m_ = std::max(at_bottom, at_top) + across;
}

Pixel ViewGeometry::project(double x_m, double y_m, double height_m) const {
    const Vec3 p = {x_m - middle_[0], y_m - middle_[1], height_m * exaggeration_ - middle_[2]};
    return {0.5 * width_ + dot(p, right_) / metres_per_pixel_,
            0.5 * height_ - dot(p, up_) / metres_per_pixel_};
}

Vec3 ViewGeometry::point(Pixel pixel, double depth_m) const {
    const double a = (pixel.x - 0.5 * width_) * metres_per_pixel_;
    const double b = (0.5 * height_ - pixel.y) * metres_per_pixel_;
    Vec3 p{};
    for (std::size_t i = 0; i < 3; ++i) {
        p[i] = middle_[i] + a * right_[i] + b * up_[i] + depth_m * forward_[i];
    }
    return p;
}

std::optional<GroundPoint> ViewGeometry::ground(Pixel pixel) const {
    if (std::abs(forward_[2]) < 1e-6) return std::nullopt;
    const Vec3 start = point(pixel, 0);
    const double depth = (ground_m_ * exaggeration_ - start[2]) / forward_[2];
    return GroundPoint{start[0] + depth * forward_[0], start[1] + depth * forward_[1]};
}

}  // namespace stormcellar::render
