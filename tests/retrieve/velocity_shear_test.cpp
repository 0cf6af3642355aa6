// Tests sweep_shear() with winds whose shear is known in closed form, with vortices as a beam
// smooths them, with noise and with odd sweeps.
#include "stormcellar/retrieve/velocity_shear.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "base/degree.h"
#include "tests/retrieve/folded_volume.h"
#include "tests/retrieve/rankine_vortex.h"
#include "tests/retrieve/velocity_sweep.h"

namespace stormcellar::retrieve {
namespace {

constexpr double no_echo = std::numeric_limits<double>::quiet_NaN();

SweepShear shear_of(const level2::Volume& volume, const SweepFolds& folds,
                    const ShearOptions& options = {}) {
    const auto found = sweep_shear(volume, folds, options);
    EXPECT_TRUE(found) << (found ? "" : found.error().message);
    return found ? *found : SweepShear{};
}

SweepShear shear_of(const level2::Volume& volume, const ShearOptions& options = {}) {
    return shear_of(volume, no_folds(volume).sweeps.at(0), options);
}

std::size_t fitted_gates(const SweepShear& shear) {
    return static_cast<std::size_t>(std::ranges::count(shear.is_fitted, 1));
}

void expect_finite(const SweepShear& shear) {
    for (std::size_t i = 0; i < shear.is_fitted.size(); ++i) {
        const bool is_fitted = shear.is_fitted[i] != 0;
        for (const float value : {shear.azimuthal_per_s[i], shear.divergence_per_s[i]})
            ASSERT_TRUE(is_fitted ? std::isfinite(value) : value == 0) << i;
        for (const float error : {shear.azimuthal_error_per_s[i], shear.divergence_error_per_s[i]})
            ASSERT_TRUE(is_fitted ? std::isfinite(error) && error > 0 : error == 0) << i;
    }
}

struct Geometry {
    int radials;
    double elevation_deg;
    int first_gate_m, gate_spacing_m;
};
const Geometry geometries[] = {{360, 0.5, 2000, 250},
                               {720, 0.5, 2125, 250},
                               {367, 4.3, -375, 250},
                               {360, 19.5, 300, 150},
                               {360, 2.4, 500, 1000}};

SweepSpec spec_of(const Geometry& geometry) {
    SweepSpec spec;
    spec.azimuths_deg = even_azimuths(geometry.radials);
    spec.elevation_deg = geometry.elevation_deg;
    spec.first_gate_m = geometry.first_gate_m;
    spec.gate_spacing_m = geometry.gate_spacing_m;
    return spec;
}

// A body turns counterclockwise by `per_s` radians a second about a point 40 km away. At all
// ranges, its velocity away from the radar is per_s * 40 km * sin(azimuth from the center), times
// the cosine of the elevation.
TEST(VelocityShear, SolidRotationIsExact) {
    constexpr double per_s = 0.0015, center_deg = 130, center_m = 40e3;
    for (const Geometry& geometry : geometries) {
        const SweepSpec spec = spec_of(geometry);
        const double level = std::cos(spec.elevation_deg * degree);
        const auto volume = volume_of(spec, [&](double azimuth_deg, double /*range_m*/) {
            return per_s * center_m * std::sin(turn_deg(center_deg, azimuth_deg) * degree) * level;
        });
        const SweepShear shear = shear_of(volume);
        expect_finite(shear);
        std::size_t seen = 0;
        for (std::size_t radial = 0; radial < spec.azimuths_deg.size(); ++radial) {
            const double turn =
                turn_deg(center_deg, static_cast<double>(spec.azimuths_deg[radial])) * degree;
            for (int gate = 5; gate + 5 < spec.gates; ++gate) {
                const std::size_t at =
                    radial * static_cast<std::size_t>(spec.gates) + static_cast<std::size_t>(gate);
                const double range_m = volume.sweeps[0].moments[0].range_m(gate);
                if (range_m < 6000 || std::abs(turn) > 1) continue;
                ++seen;
                const double exact = per_s * center_m * std::cos(turn) / (range_m * level);
                // Rounding can change the difference of two radials by a step of the codes.
                const double rounding = finest_mps / (range_m * 360 * degree / geometry.radials);
                ASSERT_NEAR(shear.azimuthal_per_s[at], exact, 1e-3 * exact + rounding) << range_m;
                ASSERT_NEAR(shear.divergence_per_s[at], 0, 1e-5);
            }
        }
        EXPECT_GT(seen, 20'000U);
    }
}

TEST(VelocityShear, LinearDivergenceIsExact) {
    constexpr double per_s = 0.001, center_m = 40e3;
    constexpr double rounding_per_s = finest_mps / 300;  // of two gates of a kernel
    for (const Geometry& geometry : geometries) {
        SweepSpec spec = spec_of(geometry);
        spec.gates = std::min(400, 100'000 / spec.gate_spacing_m);
        const double level = std::cos(spec.elevation_deg * degree);
        const auto volume = volume_of(spec, [&](double /*azimuth_deg*/, double range_m) {
            return per_s * (range_m * level - center_m) * level;
        });
        for (const MedianFilter median : {MedianFilter::off, MedianFilter::always}) {
            ShearOptions options;
            options.median = median;
            const SweepShear shear = shear_of(volume, options);
            std::size_t seen = 0;
            for (std::size_t at = 0; at < shear.is_fitted.size(); ++at) {
                const auto gate = static_cast<int>(at) % spec.gates;
                if (shear.is_fitted[at] == 0 || gate < 12 || gate + 5 > spec.gates) continue;
                ++seen;
                ASSERT_NEAR(shear.divergence_per_s[at], per_s, 1e-3 * per_s + rounding_per_s);
                ASSERT_NEAR(shear.azimuthal_per_s[at], 0, 1e-6);
            }
            EXPECT_GT(seen, 20'000U);
        }
    }
}

TEST(VelocityShear, CounterclockwiseIsPositiveInAllDirections) {
    const SweepSpec spec = spec_of(geometries[0]);
    for (const double center_deg : {0.5, 90.5, 200.5, 359.5}) {
        for (const double sign : {1.0, -1.0}) {
            const auto volume = volume_of(spec, [&](double azimuth_deg, double /*range_m*/) {
                return sign * 60 * std::sin(turn_deg(center_deg, azimuth_deg) * degree);
            });
            const SweepShear shear = shear_of(volume);
            const std::size_t at = static_cast<std::size_t>(center_deg) * 400 + 152;  // 40 km
            ASSERT_EQ(shear.is_fitted[at], 1);
            EXPECT_NEAR(shear.azimuthal_per_s[at], sign * 60 / 40e3, 1e-5) << center_deg;
        }
    }
}

class RankineVortex : public ::testing::TestWithParam<Vortex> {};

// Around the center, the shear of dealiased velocities must differ from that of the smoothed vortex
// by at most 5 % of the shear at the center.
TEST_P(RankineVortex, IsAsTheBeamAndTheKernelSmoothIt) {
    const Vortex& vortex = GetParam();
    const FoldedVolume folded = fold(vortex);
    const Dealiased found = dealias(folded.volume, Dealiasing::anchored);
    ASSERT_EQ(score(folded, found).wrong, 0);
    EXPECT_EQ(found.folded_gates > 0, vortex.is_folded);
    const SweepShear shear = shear_of(folded.volume, found.sweeps.at(0));
    const double in_the_middle = vortex.expected(Vortex::azimuth_deg, vortex.range_m);
    const auto gates = static_cast<std::size_t>(folded.volume.sweeps[0].moments[0].gate_stride);
    double peak = 0;
    for_gates_around(vortex, gates, [&](std::size_t at, double expected) {
        peak = std::max(peak, expected);
        ASSERT_EQ(shear.is_fitted[at], 1);
        EXPECT_NEAR(shear.azimuthal_per_s[at], expected, 0.05 * in_the_middle) << "gate " << at;
    });
    EXPECT_LE(peak, 1.05 * vortex.fastest_mps / vortex.radius_m) << "smoothing only lowers";
}
INSTANTIATE_TEST_SUITE_P(
    Vortices, RankineVortex,
    ::testing::Values(Vortex{20e3, 1000, 40, 33, 360, true}, Vortex{20e3, 2000, 15, 8, 360, true},
                      Vortex{50e3, 4000, 15, 8, 360, true}, Vortex{50e3, 2000, 25, 16, 360, true},
                      Vortex{50e3, 1000, 40, 33, 720, false}, Vortex{50e3, 2000, 25, 12, 720, true},
                      Vortex{100e3, 4000, 40, 33, 360, true},
                      Vortex{100e3, 4000, 25, 16, 720, true}));

// With noise alone, the values spread as much as their errors, or half as much after a median.
TEST(VelocityShear, ErrorsCoverNoise) {
    for (const int radials : {360, 720}) {
        for (const MedianFilter median : {MedianFilter::off, MedianFilter::always}) {
            FoldedSpec spec;
            spec.nyquist_mps = 30;
            spec.elevations_deg = {0.5};
            spec.radials = radials;
            spec.noise_mps = 3;
            spec.missing = 0.1;
            const FoldedVolume folded =
                fold(spec, [](double, double, double, double) { return 0; });
            ShearOptions options;
            options.median = median;
            const SweepShear shear =
                shear_of(folded.volume, no_folds(folded.volume).sweeps[0], options);
            double values = 0, errors = 0, divergences = 0, divergence_errors = 0;
            std::size_t covered = 0;
            for (std::size_t i = 0; i < shear.is_fitted.size(); ++i) {
                values += std::pow(shear.azimuthal_per_s[i], 2);
                errors += std::pow(shear.azimuthal_error_per_s[i], 2);
                divergences += std::pow(shear.divergence_per_s[i], 2);
                divergence_errors += std::pow(shear.divergence_error_per_s[i], 2);
                if (shear.is_fitted[i] != 0 &&
                    std::abs(shear.azimuthal_per_s[i]) <= 2 * shear.azimuthal_error_per_s[i])
                    ++covered;
            }
            const auto fitted = static_cast<double>(fitted_gates(shear));
            EXPECT_GT(fitted, 100'000);
            const double azimuthal = std::sqrt(values / errors);
            const double divergence = std::sqrt(divergences / divergence_errors);
            // The median lowers the spread of the values, but not their errors.
            const bool has_median = median == MedianFilter::always;
            for (const double spread : {azimuthal, divergence})
                EXPECT_NEAR(spread, has_median ? 0.5 : 1, has_median ? 0.15 : 0.05);
            EXPECT_GE(static_cast<double>(covered) / fitted, 0.9);
        }
    }
}

// The velocity is 60 m/s times the sine of the azimuth, at all ranges. The azimuths are irregular
// and begin near 300 degrees. They have a gap of 40 degrees, and the last radials overlap the
// first.
TEST(VelocityShear, IrregularRadialsGiveTheSameShear) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> jitter(-0.2F, 0.2F);
    SweepSpec spec = spec_of(geometries[0]);
    spec.azimuths_deg.clear();
    for (int radial = 0; radial < 366; ++radial) {
        const float azimuth_deg =
            std::fmod(300.0F + static_cast<float>(radial) + jitter(random), 360.0F);
        if (azimuth_deg < 100 || azimuth_deg > 140) spec.azimuths_deg.push_back(azimuth_deg);
    }
    const auto volume = volume_of(spec, [&](double azimuth_deg, double /*range_m*/) {
        return 60 * std::sin(azimuth_deg * degree);
    });
    const SweepShear shear = shear_of(volume);
    expect_finite(shear);
    std::size_t seen = 0, missing = 0;
    for (std::size_t radial = 0; radial < spec.azimuths_deg.size(); ++radial) {
        const auto azimuth_deg = static_cast<double>(spec.azimuths_deg[radial]);
        if (std::abs(std::cos(azimuth_deg * degree)) < 0.5) continue;
        for (int gate = 100; gate < 395; ++gate) {
            const std::size_t at = radial * 400 + static_cast<std::size_t>(gate);
            const double range_m = volume.sweeps[0].moments[0].range_m(gate);
            const double exact = 60 * std::cos(azimuth_deg * degree) / range_m;
            if (shear.is_fitted[at] == 0) {
                ++missing;
                continue;
            }
            // Beside the gap, the kernel has radials on one side only.
            ASSERT_NEAR(shear.azimuthal_per_s[at], exact, 0.03 * std::abs(exact)) << azimuth_deg;
            ++seen;
        }
    }
    EXPECT_GT(seen, 50'000U);
    EXPECT_LT(missing, 500U) << "beside the gap";
}

TEST(VelocityShear, GatesNearTheEdgeNeedHalfAKernel) {
    const SweepSpec spec = spec_of(geometries[0]);
    const auto volume = volume_of(spec, [](double azimuth_deg, double range_m) {
        return azimuth_deg > 90 && azimuth_deg < 180 && range_m < 60e3 ? 10.0 : no_echo;
    });
    const SweepShear shear = shear_of(volume);
    expect_finite(shear);
    const auto is_fitted = [&](int azimuth_deg, int gate) {
        return shear.is_fitted[static_cast<std::size_t>(azimuth_deg * 400 + gate)] != 0;
    };
    EXPECT_TRUE(is_fitted(120, 200));
    EXPECT_TRUE(is_fitted(120, 231)) << "6 of 9 gates have velocities";
    EXPECT_FALSE(is_fitted(120, 233)) << "beyond the echo";
    EXPECT_TRUE(is_fitted(90, 200));
    EXPECT_FALSE(is_fitted(88, 200));
    ShearOptions all;
    all.least_share = 1;
    EXPECT_LT(fitted_gates(shear_of(volume, all)), fitted_gates(shear));
}

TEST(VelocityShear, OddSweepsGiveNoShear) {
    const auto calm = [](double, double) { return 5.0; };
    SweepSpec spec = spec_of(geometries[0]);
    SweepSpec one_gate = spec, one_radial = spec, unknown_nyquist = spec, upward = spec;
    one_gate.azimuths_deg = {10};
    one_gate.gates = 1;
    one_radial.azimuths_deg = {10};
    unknown_nyquist.nyquist_mps = 0;
    upward.elevation_deg = 90;
    for (const SweepSpec& odd : {one_gate, one_radial, unknown_nyquist, upward}) {
        const SweepShear shear = shear_of(volume_of(odd, calm));
        EXPECT_EQ(fitted_gates(shear), 0U);
        EXPECT_EQ(shear.is_fitted.size(),
                  odd.azimuths_deg.size() * static_cast<std::size_t>(odd.gates));
        expect_finite(shear);
    }
    for (const double nothing : {no_echo, range_folded})
        EXPECT_EQ(fitted_gates(shear_of(volume_of(spec, [&](double, double) { return nothing; }))),
                  0U);
    const level2::Volume volume = volume_of(spec, calm);
    Dealiased ambiguous = no_folds(volume);
    std::ranges::fill(ambiguous.sweeps[0].ambiguous, std::uint8_t{1});
    EXPECT_EQ(fitted_gates(shear_of(volume, ambiguous.sweeps[0])), 0U);
}

TEST(VelocityShear, DamagedRadialsAreLeftOut) {
    const SweepSpec spec = spec_of(geometries[0]);
    level2::Volume volume = volume_of(spec, [](double, double) { return 5.0; });
    std::vector<level2::Radial>& radials = volume.sweeps[0].radials;
    radials[7].azimuth_deg = std::numeric_limits<float>::infinity();
    radials[50].elevation_deg = std::numeric_limits<float>::quiet_NaN();
    radials[90].nyquist_mps = std::numeric_limits<float>::quiet_NaN();
    for (std::size_t radial = 180; radial < 360; ++radial)
        radials[radial].nyquist_mps = 17;  // another Nyquist velocity
    volume.sweeps[0].moments[0].gate_counts[120] = 0;
    const SweepShear shear = shear_of(volume);
    expect_finite(shear);
    EXPECT_GT(fitted_gates(shear), 140'000U);
    EXPECT_EQ(shear.is_fitted[7 * 400 + 200], 0) << "a radial without an azimuth is not fitted";
    EXPECT_EQ(shear.is_fitted[180 * 400 + 200], 1)
        << "the fit crosses a change of Nyquist velocity";
}

TEST(VelocityShear, WrongArgumentsAreErrors) {
    const level2::Volume volume =
        volume_of(spec_of(geometries[0]), [](double, double) { return 5.0; });
    const SweepFolds folds = no_folds(volume).sweeps[0];
    SweepFolds other = folds;
    other.sweep = 1;
    EXPECT_FALSE(sweep_shear(volume, other));
    other = folds;
    other.moment = 1;
    EXPECT_FALSE(sweep_shear(volume, other));
    other = folds;
    other.folds.pop_back();
    EXPECT_FALSE(sweep_shear(volume, other));
    const auto is_refused = [&](const ShearOptions& options) {
        const auto found = sweep_shear(volume, folds, options);
        return !found && found.error().code == ErrorCode::bad_argument;
    };
    for (const double size_m : {0.0, -1.0, 1e9, std::numeric_limits<double>::quiet_NaN()}) {
        EXPECT_TRUE(is_refused({.kernel_azimuth_m = size_m}));
        EXPECT_TRUE(is_refused({.kernel_range_m = size_m}));
    }
    for (const double share : {0.0, 1.1, std::numeric_limits<double>::quiet_NaN()})
        EXPECT_TRUE(is_refused({.least_share = share}));
}

}  // namespace
}  // namespace stormcellar::retrieve
