// Compares the fast sums with a fit of each kernel gate by gate.
#include "retrieve/shear/plane_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "base/degree.h"
#include "tests/retrieve/velocity_sweep.h"

namespace stormcellar::retrieve {
namespace {

struct KernelGate {
    double x, y, smooth, rough;
};

struct PlainKernel {
    std::vector<KernelGate> gates;
    std::size_t size = 0;  // without gaps
};

// Collects the gates of a kernel by its definition.
PlainKernel plain_kernel(const VelocityRows& rows, const std::vector<float>& filtered,
                         const Kernel& kernel, std::size_t row, std::size_t gate) {
    const double spacing = rows.azimuth_spacing_deg * degree;
    const double arc_m = rows.range_m(gate) * std::cos(rows.elevation_deg * degree);
    const double reach = std::clamp(kernel.half_width_m / arc_m, 1.5 * spacing,
                                    std::max(15 * degree, 1.5 * spacing));
    PlainKernel found;
    std::size_t radials = 0;
    for (std::size_t other = 0; other < rows.row_count(); ++other) {
        const double turn = turn_deg(static_cast<double>(rows.azimuths_deg[row]),
                                     static_cast<double>(rows.azimuths_deg[other])) *
                            degree;
        if (std::abs(turn) > reach) continue;
        bool has_gates = false;
        for (std::size_t near = 0; near < rows.gates; ++near) {
            const double x = static_cast<double>(near) - static_cast<double>(gate);
            const std::size_t at = other * rows.gates + near;
            has_gates |= near + kernel.half_gates >= gate && !std::isnan(filtered[at]);
            if (std::abs(x) > static_cast<double>(kernel.half_gates) || std::isnan(filtered[at]))
                continue;
            found.gates.push_back({x, std::sin(turn), static_cast<double>(filtered[at]),
                                   static_cast<double>(rows.velocities_mps[at])});
        }
        if (has_gates) ++radials;
    }
    const auto expected = static_cast<std::size_t>(2 * std::floor(reach / spacing) + 1);
    found.size = (2 * kernel.half_gates + 1) * std::max(radials, expected);
    return found;
}

struct PlainSlope {
    double b = 0, b_error = 0, c = 0, c_error = 0;
};

PlainSlope plain_slope(const std::vector<KernelGate>& gates, double least_variance) {
    const auto n = static_cast<double>(gates.size());
    double x = 0, y = 0, smooth = 0, rough = 0;
    for (const KernelGate& of : gates) {
        x += of.x / n;
        y += of.y / n;
        smooth += of.smooth / n;
        rough += of.rough / n;
    }
    double xx = 0, yy = 0, xy = 0, xv = 0, yv = 0;
    for (const KernelGate& of : gates) {
        xx += (of.x - x) * (of.x - x);
        yy += (of.y - y) * (of.y - y);
        xy += (of.x - x) * (of.y - y);
        xv += (of.x - x) * (of.smooth - smooth);
        yv += (of.y - y) * (of.smooth - smooth);
    }
    const double determinant = xx * yy - xy * xy;
    const double b = (yy * xv - xy * yv) / determinant, c = (xx * yv - xy * xv) / determinant;
    double squares = 0;
    for (const KernelGate& of : gates)
        squares += std::pow(of.rough - rough - b * (of.x - x) - c * (of.y - y), 2);
    const double variance = std::max(squares / (n - 3), least_variance);
    return {b, std::sqrt(variance * yy / determinant), c, std::sqrt(variance * xx / determinant)};
}

struct Case {
    int radials;
    double gate_spacing_m, first_gate_m, jitter_deg, missing, mean_mps;
    std::size_t half_gates;
};

VelocityRows rows_of(const Case& of) {
    std::mt19937 random(3);
    std::normal_distribution<float> noise(0, 4);
    std::uniform_real_distribution<double> chance(0, 1);
    VelocityRows rows;
    rows.gates = 300;
    rows.first_gate_m = of.first_gate_m;
    rows.gate_spacing_m = of.gate_spacing_m;
    rows.elevation_deg = 3;
    rows.azimuth_spacing_deg = 360.0 / of.radials;
    rows.step_mps = 0.5;
    for (const float azimuth_deg : even_azimuths(of.radials))
        if (chance(random) > of.missing / 4)
            rows.azimuths_deg.push_back(azimuth_deg +
                                        static_cast<float>(of.jitter_deg * (chance(random) - 0.5)));
    std::ranges::sort(rows.azimuths_deg);
    for (std::size_t row = 0; row < rows.azimuths_deg.size(); ++row) {
        rows.radials.push_back(row);
        for (std::size_t gate = 0; gate < rows.gates; ++gate) {
            const bool is_missing = chance(random) < of.missing || rows.range_m(gate) < 1000;
            rows.velocities_mps.push_back(is_missing
                                              ? std::numeric_limits<float>::quiet_NaN()
                                              : static_cast<float>(of.mean_mps) + noise(random));
        }
    }
    return rows;
}

// A rotation like a solid body and a linear divergence are planes at all ranges.
TEST(PlaneFit, RotationAndDivergenceAreExact) {
    VelocityRows rows = rows_of({360, 250, 500, 0, 0, 0, 1});
    for (std::size_t row = 0; row < rows.row_count(); ++row) {
        const double sine = std::sin(static_cast<double>(rows.azimuths_deg[row]) * degree);
        for (std::size_t gate = 0; gate < rows.gates; ++gate)
            rows.row(row)[gate] = static_cast<float>(30 * sine + 0.1 * static_cast<double>(gate));
    }
    const PlaneFit fit(rows, rows.velocities_mps, {1250, 1, 0.5F});
    std::vector<PlaneSlope> slopes(rows.gates);
    for (std::size_t row = 0; row < rows.row_count(); ++row) {
        fit.fit_row(row, slopes);
        const double exact = 30 * std::cos(static_cast<double>(rows.azimuths_deg[row]) * degree);
        for (std::size_t gate = 1; gate + 1 < rows.gates; ++gate) {
            ASSERT_TRUE(slopes[gate].is_fitted);
            ASSERT_NEAR(slopes[gate].along_azimuth, exact, 30 * 2e-5) << row << " " << gate;
            ASSERT_NEAR(slopes[gate].along_range, 0.1, 2e-6);
        }
    }
}

// The fast sums must fit the same gates as the plain sums. `rough` and `smooth` velocities differ,
// so that a mix-up of the two shows.
void expect_plain_fits(const Case& of) {
    const VelocityRows rows = rows_of(of);
    std::vector<float> filtered = rows.velocities_mps;
    for (float& velocity : filtered)
        velocity *= 0.75F;
    const Kernel kernel{1250, of.half_gates, 0.5F};
    const PlaneFit fit(rows, filtered, kernel);
    std::vector<PlaneSlope> slopes(rows.gates);
    int fitted = 0, unlike = 0;
    for (std::size_t row = 0; row < rows.row_count(); row += 37) {
        fit.fit_row(row, slopes);
        for (std::size_t gate = 0; gate < rows.gates; ++gate) {
            const PlainKernel kernel_gates = plain_kernel(rows, filtered, kernel, row, gate);
            const auto count = static_cast<double>(kernel_gates.gates.size());
            const bool is_enough =
                count >= 4 && count >= 0.5 * static_cast<double>(kernel_gates.size);
            const PlaneSlope& found = slopes[gate];
            if (found.is_fitted != is_enough) {
                ++unlike;
                continue;
            }
            if (!found.is_fitted) continue;
            ++fitted;
            const PlainSlope plain = plain_slope(kernel_gates.gates, 0.25 / 12);
            const auto error = static_cast<double>(found.azimuth_error);
            ASSERT_NEAR(found.along_range, plain.b, 1e-4 * plain.b_error) << row << " " << gate;
            ASSERT_NEAR(found.range_error, plain.b_error, 1e-3 * plain.b_error);
            ASSERT_NEAR(found.along_azimuth, plain.c, 1e-4 * plain.c_error) << row << " " << gate;
            ASSERT_NEAR(error, plain.c_error, 1e-3 * plain.c_error);
        }
    }
    EXPECT_GT(fitted, 1500);
    EXPECT_LE(unlike, fitted / 100) << "kernels whose places are too close together";
}

TEST(PlaneFit, EqualsPlainSums) {
    for (const Case& of :
         {Case{360, 250, 2000, 0, 0, 0, 1}, Case{720, 250, 2125, 0, 0.3, 20, 1},
          Case{367, 250, -375, 0.4, 0.1, -15, 1}, Case{360, 150, 500, 0.2, 0.3, 0, 2},
          Case{360, 1000, 1000, 0.1, 0.2, 5, 3}}) {
        SCOPED_TRACE(std::to_string(of.radials) + " radials, " + std::to_string(of.gate_spacing_m));
        expect_plain_fits(of);
    }
}

}  // namespace
}  // namespace stormcellar::retrieve
