#include "render/volume/ray_maker.h"

#include <algorithm>
#include <cmath>

namespace stormcellar::render {
namespace {

constexpr double no_step = 1e-30;  // stands for a step of 0 along an axis, which never leaves a box

Vec3 difference(const Vec3& a, const Vec3& b, double scale) {
    return {(a[0] - b[0]) * scale, (a[1] - b[1]) * scale, (a[2] - b[2]) * scale};
}

// The part of a ray, in steps, that is inside the box.
struct Stretch {
    double first = 0, last = 0;

    void keep(double from, double to) {
        first = std::max(first, from);
        last = std::min(last, to);
    }
    // Keeps where c t^2 + b t + a <= 0; c >= 0.
    void keep_below(double a, double b, double c) {
        if (c <= 0) {
            if (b == 0 && a > 0) last = first - 1;
            if (b > 0) last = std::min(last, -a / b);
            if (b < 0) first = std::max(first, -a / b);
            return;
        }
        const double inside = b * b - 4 * a * c;
        if (!(inside > 0)) {
            last = first - 1;
            return;
        }
        const double q = -0.5 * (b + std::copysign(std::sqrt(inside), b));
        const double one = q / c;
        const double other = q == 0 ? 0 : a / q;
        keep(std::min(one, other), std::max(one, other));
    }
    // Keeps the first stretch where c t^2 + b t + a >= 0; c >= 0.
    void keep_above(double a, double b, double c) {
        Stretch below = *this;
        below.keep_below(a, b, c);
        if (!(below.first < below.last)) return;
        if (below.first > first) {
            last = std::min(last, below.first);
        } else {
            first = std::max(first, below.last);
        }
    }
};

}  // namespace

RayMaker::RayMaker(const grid::GridSpec& spec, const ViewGeometry& geometry,
                   const LevelPosition& levels, int slices)
    : geometry_(geometry),
      slices_(slices),
      step_m_((geometry.far_m() - geometry.near_m()) / slices) {
    const Pixel first{0.5, 0.5}, right{1.5, 0.5}, down{0.5, 1.5};
    const double near_m = geometry.near_m();
    start_.origin = geometry.point(first, near_m);
    start_.per_x = difference(geometry.point(right, near_m), start_.origin, 1);
    start_.per_y = difference(geometry.point(down, near_m), start_.origin, 1);
    const Vec3 along = geometry.along(first);
    step_.origin = difference(along, {}, step_m_);
    step_.per_x = difference(geometry.along(right), along, step_m_);
    step_.per_y = difference(geometry.along(down), along, step_m_);
    const double z_slope = levels.is_uniform() ? levels.slope() : 1;
    scale_ = {1 / spec.cell_width_m(), 1 / spec.cell_height_m(), z_slope};
    offset_ = {-spec.x_from_middle_m(0) / spec.cell_width_m(),
               -spec.y_from_middle_m(0) / spec.cell_height_m(),
               levels.is_uniform() ? levels.offset() : 0};
    if (geometry.drop_per_m2() > 0) {
        const double factor = geometry.drop_per_m2() * geometry.exaggeration() * z_slope;
        curve_ = CurvedLevels{static_cast<float>(factor / (scale_[0] * scale_[0])),
                              static_cast<float>(factor / (scale_[1] * scale_[1])),
                              static_cast<float>(offset_[0]), static_cast<float>(offset_[1])};
    }
}

RayPacket RayMaker::packet(std::span<const PixelPlace> pixels) const {
    std::array<Lane, 3> start{}, step{};
    Lane px{}, py{};
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        px[i] = pixels[i].x;
        py[i] = pixels[i].y;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t i = 0; i < packet_rays; ++i) {
            start[axis][i] =
                start_.origin[axis] + px[i] * start_.per_x[axis] + py[i] * start_.per_y[axis];
            step[axis][i] =
                step_.origin[axis] + px[i] * step_.per_x[axis] + py[i] * step_.per_y[axis];
        }
    }
    RayPacket rays{};
    const auto to_cells = [&](std::size_t axis, float* position, float* steps) {
        for (std::size_t i = 0; i < packet_rays; ++i) {
            position[i] = static_cast<float>(offset_[axis] + start[axis][i] * scale_[axis]);
            steps[i] = static_cast<float>(step[axis][i] * scale_[axis]);
        }
    };
    to_cells(0, rays.x, rays.step_x);
    to_cells(1, rays.y, rays.step_y);
    to_cells(2, rays.z, rays.step_z);
    for (std::size_t i = 0; i < packet_rays; ++i) {
        rays.length[i] = static_cast<float>(
            std::sqrt(step[0][i] * step[0][i] + step[1][i] * step[1][i] + step[2][i] * step[2][i]) /
            step_m_);
    }
    if (curve_) {
        clip_to_curved_box(start, step, rays);
    } else {
        clip_to_box(start, step, rays);
    }
    for (std::size_t i = pixels.size(); i < packet_rays; ++i)
        rays.enter[i] = rays.leave[i] = 0;
    return rays;
}

// Without a branch, so that compilers take the rays side by side.
void RayMaker::clip_to_box(const std::array<Lane, 3>& start, const std::array<Lane, 3>& step,
                           RayPacket& rays) const {
    const Vec3 low = {-geometry_.half_x_m(), -geometry_.half_y_m(),
                      geometry_.bottom_m() * geometry_.exaggeration()};
    const Vec3 high = {geometry_.half_x_m(), geometry_.half_y_m(),
                       geometry_.top_m() * geometry_.exaggeration()};
    Lane first{}, last{};
    last.fill(slices_);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t i = 0; i < packet_rays; ++i) {
            const double moved = step[axis][i] == 0 ? no_step : step[axis][i];
            const double a = (low[axis] - start[axis][i]) / moved;
            const double b = (high[axis] - start[axis][i]) / moved;
            const double from = a < b ? a : b;
            const double to = a < b ? b : a;
            first[i] = first[i] < from ? from : first[i];
            last[i] = last[i] > to ? to : last[i];
        }
    }
    for (std::size_t i = 0; i < packet_rays; ++i) {
        const bool crosses = first[i] < last[i];
        rays.enter[i] = crosses ? static_cast<float>(first[i]) : 0;
        rays.leave[i] = crosses ? static_cast<float>(last[i]) : 0;
    }
}

// Heights above the curved sea level are a polynomial of the step. Below the box a ray has met the
// earth: what lies beyond is hidden.
void RayMaker::clip_to_curved_box(const std::array<Lane, 3>& start, const std::array<Lane, 3>& step,
                                  RayPacket& rays) const {
    const double curve = geometry_.drop_per_m2() * geometry_.exaggeration();
    for (std::size_t i = 0; i < packet_rays; ++i) {
        const Vec3 s = {start[0][i], start[1][i], start[2][i]};
        const Vec3 d = {step[0][i], step[1][i], step[2][i]};
        Stretch inside{0, slices_};
        inside.keep_below(s[0] - geometry_.half_x_m(), d[0], 0);
        inside.keep_below(-s[0] - geometry_.half_x_m(), -d[0], 0);
        inside.keep_below(s[1] - geometry_.half_y_m(), d[1], 0);
        inside.keep_below(-s[1] - geometry_.half_y_m(), -d[1], 0);
        const double a = s[2] + curve * (s[0] * s[0] + s[1] * s[1]);
        const double b = d[2] + 2 * curve * (s[0] * d[0] + s[1] * d[1]);
        const double c = curve * (d[0] * d[0] + d[1] * d[1]);
        inside.keep_below(a - geometry_.top_m() * geometry_.exaggeration(), b, c);
        inside.keep_above(a - geometry_.bottom_m() * geometry_.exaggeration(), b, c);
        if (!(inside.first < inside.last)) continue;
        rays.enter[i] = static_cast<float>(inside.first);
        rays.leave[i] = static_cast<float>(inside.last);
    }
}

}  // namespace stormcellar::render
