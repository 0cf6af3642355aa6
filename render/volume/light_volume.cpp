#include "render/volume/light_volume.h"

#include <algorithm>
#include <cmath>

#include "base/degree.h"
#include "base/parallel.h"

namespace stormcellar::render {
namespace {

constexpr std::size_t border = 2;  // cells
constexpr double sky_elevation_deg = 35;
constexpr int sky_directions = 9;  // the zenith and eight directions around it
// The shares of the light from the sky and from the sun.
constexpr float sky_share = 0.45F;
constexpr float scattered_sky_share = 0.35F;
constexpr double forward_g = 0.4;    // parameter of the phase function
constexpr double least_phase = 0.4;  // the least share of the sun's light

Vec3 direction(double azimuth_deg, double elevation_deg) {
    const double azimuth = azimuth_deg * degree;
    const double elevation = elevation_deg * degree;
    return {std::cos(elevation) * std::sin(azimuth), std::cos(elevation) * std::cos(azimuth),
            std::sin(elevation)};
}

// Returns the phase function as a share of its value straight toward the sun.
double relative_phase(double cosine) {
    const double g2 = forward_g * forward_g;
    const double phase = std::pow(1 + g2 - 2 * forward_g * cosine, -1.5);
    const double forward = std::pow(1 + g2 - 2 * forward_g, -1.5);
    return least_phase + (1 - least_phase) * phase / forward;
}

struct Held {
    std::size_t below, above;
    float share;
};
Held held(float position, int size) {
    const float inside = std::clamp(position, 0.0F, static_cast<float>(size - 1));
    const auto below = static_cast<std::size_t>(inside);
    return {below, std::min(below + 1, static_cast<std::size_t>(size) - 1),
            inside - static_cast<float>(below)};
}

// The path of the light through the coarse cells, plane by plane along the main axis: from the
// plane `first` on, by `step`. From one plane to the next, the light moves (du, dv) cells sideways
// and crosses length_m of air.
struct LightWay {
    std::size_t main, u, v;
    int step, first;
    float length_m, du, dv;
};
LightWay way_of(const Vec3& towards, const Vec3& widths_m, const std::array<int, 3>& sizes) {
    Vec3 rate{};  // in coarse cells for each meter
    for (std::size_t axis = 0; axis < 3; ++axis)
        rate[axis] = towards[axis] / widths_m[axis];
    std::size_t main = 0;
    for (std::size_t axis = 1; axis < 3; ++axis) {
        if (std::abs(rate[axis]) > std::abs(rate[main])) main = axis;
    }
    const std::size_t u = (main + 1) % 3;
    const std::size_t v = (main + 2) % 3;
    const int step = rate[main] > 0 ? -1 : 1;
    return {main,
            u,
            v,
            step,
            step < 0 ? sizes[main] - 1 : 0,
            static_cast<float>(1 / std::abs(rate[main])),
            static_cast<float>(rate[u] / std::abs(rate[main])),
            static_cast<float>(rate[v] / std::abs(rate[main]))};
}

}  // namespace

Vec3 sun_direction(const Light& light) {
    return direction(light.sun_azimuth_deg, light.sun_elevation_deg);
}

LightVolume::LightVolume(const grid::BrickView& view, const TransferFunction& transfer,
                         double step_m, const ViewGeometry& geometry, const Light& light,
                         int threads) {
    const grid::GridSpec& spec = *view.spec;
    sizes_ = {(spec.nx + cells_across - 1) / cells_across,
              (spec.ny + cells_across - 1) / cells_across, (spec.nz() + cells_up - 1) / cells_up};
    widths_m_ = {spec.cell_width_m() * cells_across, spec.cell_height_m() * cells_across,
                 (geometry.top_m() - geometry.bottom_m()) * geometry.exaggeration() / sizes_[2]};
    extinction_.resize(index(sizes_[0] - 1, sizes_[1] - 1, sizes_[2] - 1) + 1);
    add_extinction(view, transfer, step_m);

    // The sun and the nine directions of the sky are independent sweeps, so each is a piece of
    // work.
    std::vector<std::vector<float>> swept(1 + sky_directions);
    for_each_piece(static_cast<int>(swept.size()), threads, [&](int i) {
        const Vec3 towards = i == 0   ? sun_direction(light)
                             : i == 1 ? Vec3{0, 0, 1}
                                      : direction(45.0 * (i - 2), sky_elevation_deg);
        swept[static_cast<std::size_t>(i)] = transmittance(towards);
    });
    sun_ = std::move(swept.front());
    // The light of a cell is a share from the sky and a share from the sun. With scattering, the
    // sun's share depends on the angle between the view and the sun.
    const Vec3 sun = sun_direction(light);
    const Vec3& looks = geometry.forward();
    const double cosine = looks[0] * sun[0] + looks[1] * sun[1] + looks[2] * sun[2];
    const float sky = light.scattering ? scattered_sky_share : sky_share;
    const float sunny =
        (1 - sky) * (light.scattering ? static_cast<float>(relative_phase(cosine)) : 1.0F);
    light_.resize(sun_.size());
    for (std::size_t i = 0; i < light_.size(); ++i) {
        float seen = 0;
        for (std::size_t d = 1; d < swept.size(); ++d)
            seen += swept[d][i];
        light_[i] = sky * seen / sky_directions + sunny * sun_[i];
    }
}

// Averages the extinction over the cells of each coarse cell. Cells without a value, and places
// outside the grid, count as 0.
void LightVolume::add_extinction(const grid::BrickView& view, const TransferFunction& transfer,
                                 double step_m) {
    const grid::GridSpec& spec = *view.spec;
    constexpr float share = 1.0F / (cells_across * cells_across * cells_up);
    std::vector<float> of_bin(TransferFunction::bin_count);
    for (int bin = 0; bin < TransferFunction::bin_count; ++bin) {
        of_bin[static_cast<std::size_t>(bin)] =
            share * transfer.entry(bin, bin).depth / static_cast<float>(step_m);
    }
    for (int bx = 0; bx < view.bricks_x; ++bx) {
        for (int by = 0; by < view.bricks_y; ++by) {
            for (int bz = 0; bz < view.bricks_z; ++bz) {
                const std::size_t brick = view.brick_index(bx, by, bz);
                const grid::BrickEntry& entry = view.bricks[brick];
                if (entry.kind != grid::BrickKind::stored || entry.value_count == 0 ||
                    !transfer.shows(entry.min_code, entry.max_code)) {
                    continue;
                }
                for (std::size_t cell = 0; cell < grid::brick_cells; ++cell) {
                    const std::uint16_t code = view.code_at(brick * grid::brick_cells + cell);
                    if (code < view.quantization.first_code()) continue;
                    const int x = bx * grid::brick_edge + static_cast<int>(cell >> 8);
                    const int y = by * grid::brick_edge + static_cast<int>(cell >> 4 & 15);
                    const int z = bz * grid::brick_edge + static_cast<int>(cell & 15);
                    if (x >= spec.nx || y >= spec.ny || z >= spec.nz()) continue;
                    extinction_[index(x / cells_across, y / cells_across, z / cells_up)] +=
                        of_bin[static_cast<std::size_t>(transfer.bin(code))];
                }
            }
        }
    }
}

// Computes the transmittance, beginning at the side where the light comes in, plane by plane along
// the axis with the most planes for each meter of the path. Outside the grid, the air is clear.
std::vector<float> LightVolume::transmittance(const Vec3& towards) const {
    const LightWay way = way_of(towards, widths_m_, sizes_);
    const auto place = [&](int plane, int iu, int iv) {
        std::array<int, 3> at{};
        at[way.main] = plane;
        at[way.u] = iu;
        at[way.v] = iv;
        return index(at[0], at[1], at[2]);
    };
    std::vector<float> through(extinction_.size(), 1.0F);
    // The light that got through each cell of the previous plane. The border of 1 is the clear
    // air outside the grid.
    const std::size_t row = static_cast<std::size_t>(sizes_[way.v]) + 2 * border;
    std::vector<float> passed((static_cast<std::size_t>(sizes_[way.u]) + 2 * border) * row, 1.0F);
    const auto pass = [&](int plane) {
        for (int iu = 0; iu < sizes_[way.u]; ++iu) {
            float* to = passed.data() + (static_cast<std::size_t>(iu) + border) * row + border;
            for (int iv = 0; iv < sizes_[way.v]; ++iv) {
                const std::size_t cell = place(plane, iu, iv);
                to[iv] = extinction_[cell] > 0
                             ? through[cell] * std::exp(-extinction_[cell] * way.length_m)
                             : through[cell];
            }
        }
    };
    // Each cell takes the light of the previous plane at the place from which the light comes. This
    // place is between four cells.
    for (int n = 1; n < sizes_[way.main]; ++n) {
        const int plane = way.first + n * way.step;
        pass(plane - way.step);
        for (int iu = 0; iu < sizes_[way.u]; ++iu) {
            const float pu = static_cast<float>(iu) + way.du;
            const auto u0 = static_cast<int>(std::floor(pu));
            const float su = pu - static_cast<float>(u0);
            for (int iv = 0; iv < sizes_[way.v]; ++iv) {
                const float pv = static_cast<float>(iv) + way.dv;
                const auto v0 = static_cast<int>(std::floor(pv));
                const float sv = pv - static_cast<float>(v0);
                // |du| and |dv| are at most 1, so these cells are inside the border.
                const float* from = passed.data() +
                                    static_cast<std::size_t>(u0 + static_cast<int>(border)) * row +
                                    static_cast<std::size_t>(v0 + static_cast<int>(border));
                const float low = (1 - su) * from[0] + su * from[row];
                const float high = (1 - su) * from[1] + su * from[row + 1];
                through[place(plane, iu, iv)] = (1 - sv) * low + sv * high;
            }
        }
    }
    return through;
}

float LightVolume::at(float x, float y, float z) const {
    const auto coarse = [](float cell, int cells) {
        return (cell + 0.5F) / static_cast<float>(cells) - 0.5F;
    };
    const Held hx = held(coarse(x, cells_across), sizes_[0]);
    const Held hy = held(coarse(y, cells_across), sizes_[1]);
    const Held hz = held(coarse(z, cells_up), sizes_[2]);
    const auto ny = static_cast<std::size_t>(sizes_[1]);
    const auto nz = static_cast<std::size_t>(sizes_[2]);
    const auto column = [&](std::size_t ix, std::size_t iy) {
        const float* from = light_.data() + (ix * ny + iy) * nz;
        return from[hz.below] + (from[hz.above] - from[hz.below]) * hz.share;
    };
    const float south = column(hx.below, hy.below) +
                        (column(hx.above, hy.below) - column(hx.below, hy.below)) * hx.share;
    const float north = column(hx.below, hy.above) +
                        (column(hx.above, hy.above) - column(hx.below, hy.above)) * hx.share;
    return south + (north - south) * hy.share;
}

}  // namespace stormcellar::render
