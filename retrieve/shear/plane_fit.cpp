#include "retrieve/shear/plane_fit.h"

#include <algorithm>
#include <cmath>

#include "base/degree.h"

namespace stormcellar::retrieve {
namespace {

constexpr double least_spacings = 1.5, most_reach = 15 * degree;

// A slope has three unknowns; one more velocity shows how well the plane fits.
constexpr float unknowns = 3, least_gates = 4;
// Smallest variance of the gates' places in a kernel that can be fitted: of x in gates squared, and
// of y in squared spacings of the radials. Two adjacent rows have 1/4.
constexpr float least_variance_x = 0.1F, least_variance_y = 0.06F;
// Places on one skew line cannot be fitted.
constexpr float least_independence = 1e-2F;

}  // namespace

struct PlaneFit::BlockSums {
    using Lanes = std::array<float, block>;
    // The letters are those of Sum; y is the sine of the angle.
    Lanes rows{}, n{}, x{}, xx{}, y{}, yy{}, xy{}, v{}, xv{}, yv{}, r{}, xr{}, yr{}, rr{};
};

PlaneFit::PlaneFit(const VelocityRows& rows, std::span<const float> filtered, const Kernel& kernel)
    : rows_(rows),
      kernel_(kernel),
      sums_(rows.row_count() * sums * rows.gates),
      ends_(rows.row_count()) {
    find_reach();
    for (std::size_t row = 0; row < rows.row_count(); ++row)
        add_row(row, filtered.data() + row * rows.gates);
}

void PlaneFit::find_reach() {
    const double spacing = rows_.azimuth_spacing_deg * degree;
    const double level = std::cos(rows_.elevation_deg * degree);
    for (std::size_t gate = 0; gate < rows_.gates; ++gate) {
        const double arc_m = std::max(rows_.range_m(gate) * level, 1.0);
        const double reach = std::clamp(kernel_.half_width_m / arc_m, least_spacings * spacing,
                                        std::max(most_reach, least_spacings * spacing));
        reach_.push_back(reach);
        const double radials = 2 * std::floor(reach / spacing) + 1;
        expected_rows_.push_back(static_cast<float>(radials));
    }
}

// Sums over the gates of the kernel along one radial.
void PlaneFit::add_row(std::size_t row, const float* filtered) {
    const auto gates = static_cast<std::ptrdiff_t>(rows_.gates);
    const auto half = static_cast<std::ptrdiff_t>(kernel_.half_gates);
    const float* raw_row = rows_.row(row);
    std::vector<float> valid(rows_.gates), smooth(rows_.gates), rough(rows_.gates);
    std::ptrdiff_t end = 0;
    for (std::ptrdiff_t gate = 0; gate < gates; ++gate) {
        const bool has_value = !std::isnan(raw_row[gate]);
        const auto at = static_cast<std::size_t>(gate);
        valid[at] = has_value ? 1.0F : 0.0F;
        smooth[at] = has_value ? filtered[gate] : 0.0F;
        rough[at] = has_value ? raw_row[gate] : 0.0F;
        if (has_value) end = std::min(gates, gate + half + 1);
    }
    ends_[row] = static_cast<std::size_t>(end);
    for (std::ptrdiff_t shift = -half; shift <= half; ++shift) {
        const auto far = static_cast<float>(shift);
        float* const to[] = {sum(row, n),  sum(row, x),   sum(row, xx),    sum(row, v),
                             sum(row, xv), sum(row, raw), sum(row, x_raw), sum(row, raw_raw)};
        const auto first = std::max<std::ptrdiff_t>(0, -shift);
        const auto last = std::min(end, gates - shift);
        for (std::ptrdiff_t gate = first; gate < last; ++gate) {
            const auto at = static_cast<std::size_t>(gate + shift);
            to[n][gate] += valid[at];
            to[x][gate] += far * valid[at];
            to[xx][gate] += far * far * valid[at];
            to[v][gate] += smooth[at];
            to[xv][gate] += far * smooth[at];
            to[raw][gate] += rough[at];
            to[x_raw][gate] += far * rough[at];
            to[raw_raw][gate] += rough[at] * rough[at];
        }
    }
}

// Returns the number of gates whose kernel reaches this angle. The reach falls with range.
std::size_t PlaneFit::end_of(double angle) const {
    const auto end = std::ranges::partition_point(
        reach_, [&](double reach) { return reach >= std::abs(angle); });
    return static_cast<std::size_t>(end - reach_.begin());
}

std::vector<PlaneFit::Neighbor> PlaneFit::neighbors_of(std::size_t row) const {
    std::vector<Neighbor> neighbors{{row, 0, ends_[row]}};
    const std::size_t count = rows_.row_count();
    for (const bool is_clockwise : {true, false}) {
        std::size_t other = row;
        for (std::size_t step = 1; step < count; ++step) {
            other = is_clockwise ? (other + 1) % count : (other + count - 1) % count;
            double turn_deg = static_cast<double>(rows_.azimuths_deg[other]) -
                              static_cast<double>(rows_.azimuths_deg[row]);
            if (is_clockwise && turn_deg < 0) turn_deg += 360;
            if (!is_clockwise && turn_deg > 0) turn_deg -= 360;
            const std::size_t end = end_of(turn_deg * degree);
            if (end == 0) break;
            neighbors.push_back({other, static_cast<float>(std::sin(turn_deg * degree)),
                                 std::min(end, ends_[other])});
        }
    }
    return neighbors;
}

void PlaneFit::add_neighbor(const Neighbor& neighbor, std::size_t first, std::size_t end,
                            BlockSums& total) const {
    if (neighbor.end <= first) return;
    const std::size_t count = std::min(end, neighbor.end) - first;
    const float y = neighbor.sine;
    const auto from = [&](Sum kind) { return sum(neighbor.row, kind) + first; };
    const float *of_n = from(n), *of_x = from(x), *of_xx = from(xx), *of_v = from(v),
                *of_xv = from(xv), *of_r = from(raw), *of_xr = from(x_raw), *of_rr = from(raw_raw);
    for (std::size_t i = 0; i < count; ++i) {
        total.rows[i] += 1;
        total.n[i] += of_n[i];
        total.x[i] += of_x[i];
        total.xx[i] += of_xx[i];
        total.y[i] += y * of_n[i];
        total.yy[i] += y * y * of_n[i];
        total.xy[i] += y * of_x[i];
    }
    for (std::size_t i = 0; i < count; ++i) {
        total.v[i] += of_v[i];
        total.xv[i] += of_xv[i];
        total.yv[i] += y * of_v[i];
    }
    for (std::size_t i = 0; i < count; ++i) {
        total.r[i] += of_r[i];
        total.xr[i] += of_xr[i];
        total.yr[i] += y * of_r[i];
        total.rr[i] += of_rr[i];
    }
}

void PlaneFit::solve(const BlockSums& total, std::size_t first,
                     std::span<PlaneSlope> slopes) const {
    const auto gates_a_row = static_cast<float>(2 * kernel_.half_gates + 1);
    const auto spacing = static_cast<float>(rows_.azimuth_spacing_deg * degree);
    const auto rounding = static_cast<float>(rows_.step_mps * rows_.step_mps / 12);
    for (std::size_t i = 0; i < slopes.size(); ++i) {
        // Require enough velocities.
        const float count = total.n[i];
        const float whole = gates_a_row * std::max(total.rows[i], expected_rows_[first + i]);
        if (count < std::max(least_gates, kernel_.least_share * whole)) continue;
        // Require places that are far enough apart in both directions. Names with d are sums about
        // the mean.
        const float mean_x = total.x[i] / count, mean_y = total.y[i] / count;
        const float dxx = total.xx[i] - total.x[i] * mean_x;
        const float dyy = total.yy[i] - total.y[i] * mean_y;
        const float dxy = total.xy[i] - total.x[i] * mean_y;
        const float determinant = dxx * dyy - dxy * dxy;
        if (!(dxx >= least_variance_x * count &&
              dyy >= least_variance_y * spacing * spacing * count &&
              determinant >= least_independence * dxx * dyy))
            continue;
        // Solve the normal equations.
        const float dxv = total.xv[i] - mean_x * total.v[i];
        const float dyv = total.yv[i] - mean_y * total.v[i];
        const float b = (dyy * dxv - dxy * dyv) / determinant;
        const float c = (dxx * dyv - dxy * dxv) / determinant;
        // Sum the squares of the distances of the unfiltered velocities from this plane.
        const float drr = total.rr[i] - total.r[i] * total.r[i] / count;
        const float dxr = total.xr[i] - mean_x * total.r[i];
        const float dyr = total.yr[i] - mean_y * total.r[i];
        const float squares =
            drr - 2 * (b * dxr + c * dyr) + b * b * dxx + 2 * b * c * dxy + c * c * dyy;
        const float variance = std::max(squares / (count - unknowns), rounding);
        slopes[i] = {b, std::sqrt(variance * dyy / determinant), c,
                     std::sqrt(variance * dxx / determinant), true};
    }
}

void PlaneFit::fit_row(std::size_t row, std::span<PlaneSlope> slopes) const {
    std::ranges::fill(slopes, PlaneSlope{});
    const std::vector<Neighbor> neighbors = neighbors_of(row);
    std::size_t all_end = 0;
    for (const Neighbor& neighbor : neighbors)
        all_end = std::max(all_end, neighbor.end);
    for (std::size_t first = 0; first < all_end; first += block) {
        const std::size_t end = std::min(first + block, all_end);
        BlockSums total;
        for (const Neighbor& neighbor : neighbors)
            add_neighbor(neighbor, first, end, total);
        solve(total, first, slopes.subspan(first, end - first));
    }
}

}  // namespace stormcellar::retrieve
