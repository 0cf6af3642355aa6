#include "render/volume/reference_marcher.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stormcellar::render {
namespace {

double distance(const Vec3& a, const Vec3& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

// The cells below and above a position, and the position's share of the way between them.
struct Pair {
    std::size_t below, above;
    double share;
};
Pair pair_at(double position, int cells) {
    const double inside = std::clamp(position, 0.0, cells - 1.0);
    const auto below = static_cast<std::size_t>(inside);
    return {below, std::min(below + 1, static_cast<std::size_t>(cells) - 1),
            inside - static_cast<double>(below)};
}

double level_position(const std::vector<double>& levels_m, double height_m) {
    if (height_m <= levels_m.front()) return 0;
    if (height_m >= levels_m.back()) return static_cast<double>(levels_m.size()) - 1;
    const auto above = std::upper_bound(levels_m.begin(), levels_m.end(), height_m);
    const double low = *(above - 1);
    return static_cast<double>(above - 1 - levels_m.begin()) + (height_m - low) / (*above - low);
}

}  // namespace

ReferenceMarcher::ReferenceMarcher(const grid::BrickView& view, const ColorTable& table,
                                   const ViewGeometry& geometry, double opacity)
    : geometry_(geometry), table_(table), spec_(*view.spec), opacity_(opacity) {
    values_.reserve(spec_.cell_count());
    for (int ix = 0; ix < spec_.nx; ++ix) {
        for (int iy = 0; iy < spec_.ny; ++iy) {
            const std::size_t column = view.offset_x(ix) + view.offset_y(iy);
            for (int iz = 0; iz < spec_.nz(); ++iz) {
                const std::uint16_t code = view.code_at(column + view.offset_z(iz));
                values_.push_back(code < view.quantization.first_code()
                                      ? std::numeric_limits<float>::quiet_NaN()
                                      : view.quantization.value_of(code));
            }
        }
    }
}

bool ReferenceMarcher::is_inside(const Vec3& point) const {
    const double height = geometry_.height_at(point);
    return std::abs(point[0]) <= geometry_.half_x_m() &&
           std::abs(point[1]) <= geometry_.half_y_m() && height >= geometry_.bottom_m() &&
           height <= geometry_.top_m();
}

ReferenceMarcher::Sample ReferenceMarcher::sample(const Vec3& point) const {
    if (!is_inside(point)) return {};
    const double height = geometry_.height_at(point);
    const Pair x = pair_at((point[0] - spec_.x_from_middle_m(0)) / spec_.cell_width_m(), spec_.nx);
    const Pair y = pair_at((point[1] - spec_.y_from_middle_m(0)) / spec_.cell_height_m(), spec_.ny);
    const Pair z = pair_at(level_position(spec_.levels_m, height), spec_.nz());
    const auto ny = static_cast<std::size_t>(spec_.ny);
    const auto nz = static_cast<std::size_t>(spec_.nz());
    Sample sample;
    for (int corner = 0; corner < 8; ++corner) {
        const bool east = (corner & 1) != 0;
        const bool north = (corner & 2) != 0;
        const bool up = (corner & 4) != 0;
        const std::size_t column = (east ? x.above : x.below) * ny + (north ? y.above : y.below);
        const float value = values_[column * nz + (up ? z.above : z.below)];
        if (std::isnan(value)) continue;
        const double weight = (east ? x.share : 1 - x.share) * (north ? y.share : 1 - y.share) *
                              (up ? z.share : 1 - z.share);
        sample.share += weight;
        sample.value += weight * static_cast<double>(value);
    }
    if (sample.share > 0) sample.value /= sample.share;
    return sample;
}

std::array<double, 4> ReferenceMarcher::ray(Pixel pixel, int steps) const {
    return lit_ray(pixel, steps, nullptr).color;
}

double ReferenceMarcher::light_at(const ShadeField& shades, const Vec3& point) const {
    return shades.at((point[0] - spec_.x_from_middle_m(0)) / spec_.cell_width_m(),
                     (point[1] - spec_.y_from_middle_m(0)) / spec_.cell_height_m(),
                     level_position(spec_.levels_m, geometry_.height_at(point)));
}

ReferenceMarcher::Lit ReferenceMarcher::lit_ray(Pixel pixel, int steps,
                                                const ShadeField* shades) const {
    const double step = (geometry_.far_m() - geometry_.near_m()) / steps;
    const double length = distance(geometry_.point(pixel, geometry_.near_m()),
                                   geometry_.point(pixel, geometry_.near_m() + step));
    Lit lit;
    double through = 1;
    bool above_ground = false;
    for (int k = 0; k < steps && through > 1e-6; ++k) {
        const Vec3 point = geometry_.point(pixel, geometry_.near_m() + (k + 0.5) * step);
        const bool below = geometry_.height_at(point) < geometry_.bottom_m();
        if (above_ground && below) break;
        above_ground = above_ground || (!below && is_inside(point));
        const Sample found = sample(point);
        if (found.share <= 0) continue;
        const auto shown = color_of(table_, static_cast<float>(found.value));
        if (!shown) continue;
        const double depth = extinction_per_m(table_, found.value, opacity_) * length * found.share;
        const double alpha = -std::expm1(-depth);
        for (std::size_t c = 0; c < 3; ++c)
            lit.color[c] += through * alpha * (*shown)[c] / 255.0;
        lit.light += through * alpha * (shades != nullptr ? light_at(*shades, point) : 1);
        through *= 1 - alpha;
    }
    lit.color[3] = 1 - through;
    return lit;
}

}  // namespace stormcellar::render
