// tests/render/reference_marcher.h -- the slicer's oracle: slow, in double, one ray at a time.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "render/colour/colour_table.h"
#include "render/view_geometry.h"
#include "render/volume/transfer_function.h"

namespace stormcellar::render {

// Value and share of valued cells at a point of drawn space; share 0: nothing there.
struct ReferenceSample {
    double value = 0, share = 0;
};

inline ReferenceSample reference_sample(const grid::BrickView& view, const ViewGeometry& geometry,
                                        const Vec3& p) {
    const grid::GridSpec& spec = *view.spec;
    const double height = p[2] / geometry.exaggeration();
    if (std::abs(p[0]) > geometry.half_x_m() || std::abs(p[1]) > geometry.half_y_m() ||
        height < geometry.bottom_m() || height > geometry.top_m()) {
        return {};
    }
    const double fx = std::clamp((p[0] - spec.x_m(0)) / spec.cell_width_m(), 0.0, spec.nx - 1.0);
    const double fy = std::clamp((p[1] - spec.y_m(0)) / spec.cell_height_m(), 0.0, spec.ny - 1.0);
    double fz = 0;
    for (int i = 0; i + 1 < spec.nz(); ++i) {
        const double low = spec.levels_m[static_cast<std::size_t>(i)];
        const double high = spec.levels_m[static_cast<std::size_t>(i) + 1];
        if (height >= low) fz = i + std::min(1.0, (height - low) / (high - low));
    }
    ReferenceSample sample;
    for (int corner = 0; corner < 8; ++corner) {
        const int ix = std::min(static_cast<int>(fx) + (corner & 1), spec.nx - 1);
        const int iy = std::min(static_cast<int>(fy) + ((corner >> 1) & 1), spec.ny - 1);
        const int iz = std::min(static_cast<int>(fz) + (corner >> 2), spec.nz() - 1);
        const auto part = [](double f, int upper) {
            const double above = f - std::floor(f);
            return upper != 0 ? above : 1 - above;
        };
        const double weight =
            part(fx, corner & 1) * part(fy, (corner >> 1) & 1) * part(fz, corner >> 2);
        if (view.status(ix, iy, iz) != grid::CellStatus::value) continue;
        sample.share += weight;
        sample.value += weight * static_cast<double>(view.value(ix, iy, iz));
    }
    if (sample.share > 0) sample.value /= sample.share;
    return sample;
}

// Red, green, blue premultiplied (0..1) and alpha.
inline std::array<double, 4> reference_ray(const grid::BrickView& view,
                                           const ViewGeometry& geometry, Pixel pixel, int steps,
                                           double opacity) {
    const double step = (geometry.far_m() - geometry.near_m()) / steps;
    std::array<double, 4> colour{};
    double through = 1;
    for (int k = 0; k < steps; ++k) {
        const Vec3 p = geometry.point(pixel, geometry.near_m() + (k + 0.5) * step);
        const ReferenceSample sample = reference_sample(view, geometry, p);
        if (sample.share <= 0) continue;
        // As the transfer function says: by bins, with their slack of 1/64.
        const double bin = std::floor((sample.value - TransferFunction::first_bin_dbz) /
                                          TransferFunction::bin_dbz +
                                      1.0 / 64);
        const double value =
            TransferFunction::first_bin_dbz + TransferFunction::bin_dbz * std::min(bin, 255.0);
        const auto classed = colour_of(nws_reflectivity(), static_cast<float>(value));
        if (!classed) continue;
        const double alpha =
            -std::expm1(-extinction_per_m(nws_reflectivity(), value, opacity) * step) *
            sample.share;
        for (std::size_t c = 0; c < 3; ++c)
            colour[c] += through * alpha * (*classed)[c] / 255.0;
        through *= 1 - alpha;
    }
    colour[3] = 1 - through;
    return colour;
}

}  // namespace stormcellar::render
