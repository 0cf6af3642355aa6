#include "render/volume/ray_maker.h"

#include <algorithm>
#include <array>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/volume/ray_maker.cpp"
#include <hwy/foreach_target.h>
// This include must come after foreach_target.h, which compiles this file once for each target.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace stormcellar::render::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Doubles = hn::CappedTag<double, packet_rays>;
using DoubleVec = hn::Vec<Doubles>;

HWY_INLINE DoubleVec at(const RayLines::Linear& linear, std::size_t axis, DoubleVec x,
                        DoubleVec y) {
    const Doubles d;
    return hn::Add(
        hn::Add(hn::Set(d, linear.origin[axis]), hn::Mul(x, hn::Set(d, linear.per_x[axis]))),
        hn::Mul(y, hn::Set(d, linear.per_y[axis])));
}

// The step of each ray along the three axes, its reciprocals, and its length.
struct Steps {
    DoubleVec step[3], inverse[3], length;

    HWY_INLINE Steps(const RayLines& lines, DoubleVec x, DoubleVec y) {
        // Replaces a step of 0 along an axis, so that the ray never leaves the box there.
        constexpr double no_step = 1e-30;
        const Doubles d;
        DoubleVec square = hn::Zero(d);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            step[axis] = at(lines.step, axis, x, y);
            const auto stands = hn::Eq(step[axis], hn::Zero(d));
            inverse[axis] =
                hn::Div(hn::Set(d, 1.0), hn::IfThenElse(stands, hn::Set(d, no_step), step[axis]));
            square = hn::Add(square, hn::Mul(step[axis], step[axis]));
        }
        length = hn::Div(hn::Sqrt(square), hn::Set(d, lines.step_m));
    }
};

// Makes the rays of the pixels at (px, py), clipped to the box. In a parallel view all rays have
// the same step; in perspective, each has its own. A ray crosses the two planes of each axis at two
// values of t. The ray is inside the box from its last entry to its first exit, over the three
// axes.
void make_packet(const RayLines& lines, const double* px, const double* py, RayPacket& rays) {
    const Doubles d;
    const hn::Rebind<float, Doubles> f;
    const auto lanes = static_cast<int>(hn::Lanes(d));
    float* const starts[3] = {rays.x, rays.y, rays.z};
    float* const moves[3] = {rays.step_x, rays.step_y, rays.step_z};
    Steps steps(lines, hn::Zero(d), hn::Zero(d));
    for (int ray = 0; ray < packet_rays; ray += lanes) {
        const DoubleVec x = hn::LoadU(d, px + ray), y = hn::LoadU(d, py + ray);
        if (!lines.parallel) steps = Steps(lines, x, y);
        DoubleVec first = hn::Zero(d), last = hn::Set(d, lines.slices);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const DoubleVec start = at(lines.start, axis, x, y);
            const DoubleVec scale = hn::Set(d, lines.scale[axis]);
            const DoubleVec position =
                hn::Add(hn::Set(d, lines.offset[axis]), hn::Mul(start, scale));
            hn::StoreU(hn::DemoteTo(f, position), f, starts[axis] + ray);
            hn::StoreU(hn::DemoteTo(f, hn::Mul(steps.step[axis], scale)), f, moves[axis] + ray);
            const auto meets = [&](double side) {
                return hn::Mul(hn::Sub(hn::Set(d, side), start), steps.inverse[axis]);
            };
            const DoubleVec a = meets(lines.low[axis]), b = meets(lines.high[axis]);
            first = hn::Max(first, hn::Min(a, b));
            last = hn::Min(last, hn::Max(a, b));
        }
        const auto crosses = hn::Lt(first, last);
        hn::StoreU(hn::DemoteTo(f, steps.length), f, rays.length + ray);
        hn::StoreU(hn::DemoteTo(f, hn::IfThenElseZero(crosses, first)), f, rays.enter + ray);
        hn::StoreU(hn::DemoteTo(f, hn::IfThenElseZero(crosses, last)), f, rays.leave + ray);
    }
}

}  // namespace stormcellar::render::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace stormcellar::render {

HWY_EXPORT(make_packet);

namespace {

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
    // Keeps the part where c t^2 + b t + a <= 0, for c >= 0. This is the part between the two
    // roots, which are computed as q / c and a / q, so that neither is the difference of nearly
    // equal numbers.
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
    // Keeps the first part where c t^2 + b t + a >= 0, for c >= 0.
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

// The start and the step of a ray are linear in the pixel, so three pixels determine the rays of
// all pixels.
RayMaker::RayMaker(const grid::GridSpec& spec, const ViewGeometry& geometry,
                   const LevelPosition& levels, int slices)
    : geometry_(geometry) {
    lines_.slices = slices;
    lines_.step_m = (geometry.far_m() - geometry.near_m()) / slices;
    lines_.parallel = !geometry.is_perspective();
    const Pixel first{0.5, 0.5}, right{1.5, 0.5}, down{0.5, 1.5};
    const double near_m = geometry.near_m();
    RayLines::Linear& start = lines_.start;
    start.origin = geometry.point(first, near_m);
    start.per_x = difference(geometry.point(right, near_m), start.origin, 1);
    start.per_y = difference(geometry.point(down, near_m), start.origin, 1);
    const Vec3 along = geometry.along(first);
    lines_.step.origin = difference(along, {}, lines_.step_m);
    lines_.step.per_x = difference(geometry.along(right), along, lines_.step_m);
    lines_.step.per_y = difference(geometry.along(down), along, lines_.step_m);
    const double z_slope = levels.is_uniform() ? levels.slope() : 1;
    lines_.scale = {1 / spec.cell_width_m(), 1 / spec.cell_height_m(), z_slope};
    lines_.offset = {-spec.x_from_middle_m(0) / spec.cell_width_m(),
                     -spec.y_from_middle_m(0) / spec.cell_height_m(),
                     levels.is_uniform() ? levels.offset() : 0};
    const double exaggeration = geometry.exaggeration();
    lines_.low = {-geometry.half_x_m(), -geometry.half_y_m(), geometry.bottom_m() * exaggeration};
    lines_.high = {geometry.half_x_m(), geometry.half_y_m(), geometry.top_m() * exaggeration};
    // On a curved earth the drop is r^2 times a factor. In positions of cells, it can be added to
    // the z of a sample without computing meters.
    if (geometry.drop_per_m2() > 0) {
        const double factor = geometry.drop_per_m2() * exaggeration * z_slope;
        const Vec3& scale = lines_.scale;
        curve_ = CurvedLevels{static_cast<float>(factor / (scale[0] * scale[0])),
                              static_cast<float>(factor / (scale[1] * scale[1])),
                              static_cast<float>(lines_.offset[0]),
                              static_cast<float>(lines_.offset[1])};
    }
}

RayPacket RayMaker::packet(std::span<const PixelPlace> pixels) const {
    std::array<double, packet_rays> x{}, y{};
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        x[i] = pixels[i].x;
        y[i] = pixels[i].y;
    }
    RayPacket rays;
    HWY_DYNAMIC_DISPATCH(make_packet)(lines_, x.data(), y.data(), rays);
    if (curve_) clip_to_curved_box(pixels, rays);
    for (std::size_t i = pixels.size(); i < packet_rays; ++i)
        rays.enter[i] = rays.leave[i] = 0;
    return rays;
}

// Clips rays on a curved earth. The height above the curved sea level is a polynomial of second
// degree in the step, so the top and the bottom of the box each give a quadratic inequality. A ray
// that falls below the box has met the earth, which hides everything beyond.
void RayMaker::clip_to_curved_box(std::span<const PixelPlace> pixels, RayPacket& rays) const {
    const double curve = geometry_.drop_per_m2() * geometry_.exaggeration();
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        Vec3 s, d;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            s[axis] = lines_.start.at(axis, pixels[i].x, pixels[i].y);
            d[axis] = lines_.step.at(axis, pixels[i].x, pixels[i].y);
        }
        Stretch inside{0, lines_.slices};
        inside.keep_below(s[0] - geometry_.half_x_m(), d[0], 0);
        inside.keep_below(-s[0] - geometry_.half_x_m(), -d[0], 0);
        inside.keep_below(s[1] - geometry_.half_y_m(), d[1], 0);
        inside.keep_below(-s[1] - geometry_.half_y_m(), -d[1], 0);
        const double a = s[2] + curve * (s[0] * s[0] + s[1] * s[1]);
        const double b = d[2] + 2 * curve * (s[0] * d[0] + s[1] * d[1]);
        const double c = curve * (d[0] * d[0] + d[1] * d[1]);
        inside.keep_below(a - geometry_.top_m() * geometry_.exaggeration(), b, c);
        inside.keep_above(a - geometry_.bottom_m() * geometry_.exaggeration(), b, c);
        rays.enter[i] = rays.leave[i] = 0;
        if (!(inside.first < inside.last)) continue;
        rays.enter[i] = static_cast<float>(inside.first);
        rays.leave[i] = static_cast<float>(inside.last);
    }
}

}  // namespace stormcellar::render
#endif
