// Tests wind_profile() with winds that are known at every gate, with volumes that have no wind, and
// with birds.
#include "stormcellar/retrieve/wind_profile.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "base/degree.h"
#include "tests/retrieve/folded_volume.h"

namespace stormcellar::retrieve {
namespace {

using Layers = std::vector<WindLayer>;

constexpr float nan_value = std::numeric_limits<float>::quiet_NaN();

FoldedSpec full_volume(double nyquist_mps) {
    FoldedSpec spec;
    spec.nyquist_mps = nyquist_mps;
    spec.elevations_deg = {0.5, 1.5, 2.5, 3.5, 5, 7, 10, 14, 19.5};
    spec.gates = 140;  // 2 to 37 km
    return spec;
}

double seen_of(const Motion& wind, double azimuth_deg, double elevation_deg) {
    return (wind.u_mps * std::sin(azimuth_deg * degree) +
            wind.v_mps * std::cos(azimuth_deg * degree)) *
           std::cos(elevation_deg * degree);
}

// Makes the velocities of a wind that depends on height alone.
template <class WindOfHeight>
RadialVelocity seen_everywhere(WindOfHeight wind) {
    return [wind](double azimuth, double /*range*/, double elevation, double height) {
        return seen_of(wind(height), azimuth, elevation);
    };
}

Motion uniform_wind(double /*height_m*/) {
    return {18, 22};
}

// From 8 m/s from the south at the antenna to 45 m/s from the west at 8 km.
Motion sheared_wind(double height_m) {
    const double part = std::min(height_m / 8000, 1.0);
    return {45 * part, 8 * (1 - part)};
}

Layers profile_of(const level2::Volume& volume, Dealiasing rung = Dealiasing::anchored,
                  const WindProfileOptions& options = {}) {
    const auto layers = wind_profile(volume, dealias(volume, rung), options);
    EXPECT_TRUE(layers) << layers.error().message;
    return layers.value_or(Layers{});
}

Layers profile_of(const FoldedSpec& spec, const RadialVelocity& velocity) {
    return profile_of(fold(spec, velocity).volume);
}

std::size_t layers_with_wind(const Layers& layers) {
    return static_cast<std::size_t>(std::ranges::count_if(
        layers, [](const WindLayer& layer) { return layer.wind.has_value(); }));
}

// Expects that no layer has a wind, and that all layers with echo have this reason.
void expect_no_wind(const Layers& layers, NoWind reason) {
    bool is_found = false;
    for (const WindLayer& layer : layers) {
        ASSERT_FALSE(layer.wind) << layer.bottom_m;
        is_found |= layer.wind.error() == reason;
        EXPECT_TRUE(layer.wind.error() == reason || layer.wind.error() == NoWind::no_echo)
            << layer.bottom_m << ": " << text_of(layer.wind.error());
    }
    EXPECT_TRUE(is_found);
}

class WindOfSyntheticVolume : public ::testing::TestWithParam<double> {};

TEST_P(WindOfSyntheticVolume, IsWithinAQuarterOfAMeterASecond) {
    for (const auto wind : {uniform_wind, sheared_wind}) {
        const Layers layers = profile_of(full_volume(GetParam()), seen_everywhere(wind));
        EXPECT_GE(layers_with_wind(layers), 55U) << "up to 10 km, with gaps between the sweeps";
        for (const WindLayer& layer : layers) {
            if (!layer.wind) continue;
            const Motion truth = wind(layer.middle_m());
            EXPECT_NEAR(layer.wind->motion.u_mps, truth.u_mps, 0.25) << layer.bottom_m;
            EXPECT_NEAR(layer.wind->motion.v_mps, truth.v_mps, 0.25) << layer.bottom_m;
            EXPECT_NEAR(layer.wind->rms_mps, 1, 0.2) << layer.bottom_m;
        }
    }
}
INSTANTIATE_TEST_SUITE_P(Nyquist, WindOfSyntheticVolume,
                         ::testing::Values(8.0, 12.0, 16.0, 24.0, 33.0));

// Nearly every gate outside the two zero lines is folded once or more.
TEST(WindProfile, IsRightWhereNearlyAllGatesAreFolded) {
    const auto gale = [](double) { return Motion{-40, 35}; };
    const Layers layers = profile_of(full_volume(8), seen_everywhere(gale));
    EXPECT_GE(layers_with_wind(layers), 50U);
    for (const WindLayer& layer : layers) {
        if (!layer.wind) continue;
        EXPECT_NEAR(layer.wind->motion.u_mps, -40, 0.5) << layer.bottom_m;
        EXPECT_NEAR(layer.wind->motion.v_mps, 35, 0.5) << layer.bottom_m;
        EXPECT_NEAR(layer.wind->motion.speed_mps(), std::hypot(40, 35), 0.7);
        EXPECT_NEAR(layer.wind->motion.direction_deg(), 131.2, 1) << "from the south-east";
    }
}

// Fits 20 volumes with other noise and other echo. The standard error must be the scatter of the
// results, within a factor of 1.5.
TEST(WindProfile, StandardErrorsAreTheScatterOfTheResults) {
    const std::size_t layer_number = 5;
    double squares = 0, variances = 0;
    int volumes = 0;
    for (int seed = 0; seed < 20; ++seed) {
        std::mt19937 random(static_cast<unsigned>(seed));
        std::normal_distribution<double> noise(0, 3);
        std::array<double, 72> of_sector{};  // shared by the gates of 5 degrees
        for (double& error : of_sector)
            error = noise(random);
        const Layers layers =
            profile_of(full_volume(33), [&](double azimuth, double, double elevation, double) {
                return seen_of({10, 5}, azimuth, elevation) +
                       of_sector[static_cast<std::size_t>(azimuth / 5)];
            });
        const auto& wind = layers[layer_number].wind;
        ASSERT_TRUE(wind);
        squares += std::pow(wind->motion.u_mps - 10, 2) + std::pow(wind->motion.v_mps - 5, 2);
        variances += std::pow(wind->u_error_mps, 2) + std::pow(wind->v_error_mps, 2);
        ++volumes;
    }
    EXPECT_GT(std::sqrt(squares / volumes), 0.3);
    EXPECT_NEAR(std::sqrt(variances / squares), 1, 0.5);
}

// In 60 degrees of azimuth all gates have the velocity of something other than the wind.
TEST(WindProfile, RejectsASectorThatMovesOtherwise) {
    const FoldedVolume mixed =
        fold(full_volume(60), [](double azimuth, double, double elevation, double height) {
            return azimuth < 60 ? -20 : seen_of(sheared_wind(height), azimuth, elevation);
        });
    const Layers layers = profile_of(mixed.volume, Dealiasing::off);
    for (const WindLayer& layer : layers) {
        if (!layer.wind) continue;
        EXPECT_NEAR(layer.wind->motion.u_mps, sheared_wind(layer.middle_m()).u_mps, 0.5);
        EXPECT_NEAR(layer.wind->motion.v_mps, sheared_wind(layer.middle_m()).v_mps, 0.5);
        EXPECT_GT(layer.wind->rejected_gates, layer.wind->gates / 7);
        EXPECT_EQ(layer.wind->gap_deg, 60);
    }
    EXPECT_GE(layers_with_wind(layers), 50U);
}

TEST(WindProfile, MeasuresFallSpeed) {
    const Layers layers =
        profile_of(full_volume(33), [](double azimuth, double, double elevation, double) {
            return seen_of({5, -5}, azimuth, elevation) - 7 * std::sin(elevation * degree);
        });
    ASSERT_TRUE(layers[40].wind && layers[40].wind->w_mps);
    EXPECT_NEAR(*layers[40].wind->w_mps, -7, 0.3);
    EXPECT_NEAR(layers[40].wind->motion.u_mps, 5, 0.2);
}

// Three of five gates are clutter, whose velocity is zero.
TEST(WindProfile, IsRightInClutter) {
    std::mt19937 random(3);
    std::uniform_int_distribution<int> fifth(1, 5);
    FoldedSpec spec = full_volume(60);
    spec.noise_mps = 0.4;
    const FoldedVolume mixed =
        fold(spec, [&](double azimuth, double, double elevation, double height) {
            return fifth(random) <= 3 ? 0 : seen_of(sheared_wind(height), azimuth, elevation);
        });
    int checked = 0;
    for (const WindLayer& layer : profile_of(mixed.volume, Dealiasing::off)) {
        const Motion truth = sheared_wind(layer.middle_m());
        if (!layer.wind || truth.speed_mps() < 12) continue;
        EXPECT_NEAR(layer.wind->motion.u_mps, truth.u_mps, 1) << layer.bottom_m;
        EXPECT_NEAR(layer.wind->motion.v_mps, truth.v_mps, 1) << layer.bottom_m;
        ++checked;
    }
    EXPECT_GE(checked, 45);
}

// Half of the circle moves with one wind, and the other half with the opposite wind.
TEST(WindProfile, TwoWindsAreNoWind) {
    const Layers layers =
        profile_of(full_volume(33), [](double azimuth, double, double elevation, double) {
            return std::fmod(azimuth, 90) < 45 ? seen_of({8, 0}, azimuth, elevation)
                                               : seen_of({-8, 4}, azimuth, elevation);
        });
    expect_no_wind(layers, NoWind::scattered);
}

TEST(WindProfile, ClutterAloneIsNoWind) {
    FoldedSpec spec = full_volume(33);
    spec.noise_mps = 0.4;
    const auto calm = [](double) { return Motion{}; };
    expect_no_wind(profile_of(spec, seen_everywhere(calm)), NoWind::clutter);
}

// With level beams, w has no effect.
TEST(WindProfile, FitsLevelBeamsWithoutAVerticalVelocity) {
    FoldedSpec level = full_volume(33);
    level.elevations_deg = {0};
    const Layers layers = profile_of(level, seen_everywhere(uniform_wind));
    ASSERT_TRUE(layers[0].wind);
    EXPECT_FALSE(layers[0].wind->w_mps);
    EXPECT_NEAR(layers[0].wind->motion.v_mps, 22, 0.5);
}

TEST(WindProfile, VolumesWithoutWindHaveAReason) {
    expect_no_wind(profile_of(level2::Volume{}), NoWind::no_echo);
    const auto no_echo = [](double, double, double, double) {
        return std::numeric_limits<double>::quiet_NaN();
    };
    expect_no_wind(profile_of(full_volume(20), no_echo), NoWind::no_echo);
    FoldedSpec one_gate = full_volume(20);
    one_gate.radials = 1;
    one_gate.missing = 0;
    one_gate.gates = 20;
    expect_no_wind(profile_of(one_gate, seen_everywhere(uniform_wind)), NoWind::too_few_gates);
    const auto half = [](double azimuth, double, double elevation, double) {
        return azimuth < 180 ? seen_of({10, 10}, azimuth, elevation)
                             : std::numeric_limits<double>::quiet_NaN();
    };
    expect_no_wind(profile_of(full_volume(20), half), NoWind::azimuth_gap);
}

TEST(WindProfile, VolumesWithoutVelocityOrNyquistVelocityHaveAReason) {
    FoldedVolume folded = fold(full_volume(20), seen_everywhere(uniform_wind));
    for (const float missing : {0.0F, nan_value}) {
        for (level2::Sweep& sweep : folded.volume.sweeps)
            for (level2::Radial& radial : sweep.radials)
                radial.nyquist_mps = missing;
        for (const WindLayer& layer : profile_of(folded.volume)) {
            ASSERT_FALSE(layer.wind);
            EXPECT_EQ(layer.wind.error(), NoWind::no_nyquist);
        }
    }
    for (level2::Sweep& sweep : folded.volume.sweeps)
        sweep.moments[0].moment = level2::Moment::ref;
    expect_no_wind(profile_of(folded.volume), NoWind::no_echo);
}

TEST(WindProfile, NoiseAloneIsNoWind) {
    for (const double nyquist : {8.0, 12.0, 26.0}) {
        std::mt19937 random(1);
        std::uniform_real_distribution<double> any(-nyquist, nyquist);
        for (const Dealiasing rung : {Dealiasing::off, Dealiasing::anchored}) {
            FoldedSpec spec = full_volume(nyquist);
            spec.elevations_deg = {1.5, 10};
            spec.radials = 120;
            const FoldedVolume noise =
                fold(spec, [&](double, double, double, double) { return any(random); });
            EXPECT_EQ(layers_with_wind(profile_of(noise.volume, rung)), 0U)
                << nyquist << ", " << static_cast<int>(rung);
        }
    }
}

// Adds reflectivity or correlation to each sweep, the same at all gates.
void add_moment(level2::Volume& volume, level2::Moment name, float value) {
    for (level2::Sweep& sweep : volume.sweeps) {
        level2::SweepMoment moment = sweep.moments[0];
        moment.moment = name;
        moment.scale = 100;
        moment.offset = 100;
        const auto code = static_cast<std::uint16_t>(std::lround(value * 100 + 100));
        moment.word_size_bits = 16;
        moment.codes16.assign(moment.codes8.size(), code);
        sweep.moments.push_back(moment);
    }
}

std::array<Birds, 2> birds_of(double noise_mps, level2::Moment name, float value) {
    FoldedSpec spec = full_volume(33);
    spec.noise_mps = noise_mps;
    FoldedVolume folded = fold(spec, seen_everywhere(uniform_wind));
    add_moment(folded.volume, name, value);
    const Layers layers = profile_of(folded.volume);
    return {layers[5].wind->birds, layers[30].wind->birds};  // at 1.1 and 6.1 km
}

TEST(WindProfile, MarksBirds) {
    using enum level2::Moment;
    using Both = std::array<Birds, 2>;
    EXPECT_EQ(birds_of(2, rho, 0.7F), (Both{Birds::likely, Birds::likely}));
    EXPECT_EQ(birds_of(3, rho, 0.99F), (Both{Birds::none, Birds::none})) << "rain";
    EXPECT_EQ(birds_of(0.5, rho, 0.7F), (Both{Birds::none, Birds::none})) << "insects";
    EXPECT_EQ(birds_of(3, ref, 5), (Both{Birds::possible, Birds::none}));
    EXPECT_EQ(birds_of(1.2, ref, 5), (Both{Birds::none, Birds::none}));
}

TEST(WindProfile, FindsCorrelationInTheOtherHalfOfASplitCut) {
    FoldedSpec spec = full_volume(33);
    spec.noise_mps = 2;
    FoldedVolume folded = fold(spec, seen_everywhere(uniform_wind));
    level2::Volume surveillance = folded.volume;
    add_moment(surveillance, level2::Moment::rho, 0.7F);
    for (level2::Sweep& sweep : surveillance.sweeps) {
        sweep.moments.erase(sweep.moments.begin());
        folded.volume.sweeps.push_back(sweep);
    }
    EXPECT_EQ(profile_of(folded.volume)[5].wind->birds, Birds::likely);
}

TEST(WindProfile, RefusesOtherFoldsAndOptions) {
    const FoldedVolume folded = fold(full_volume(20), seen_everywhere(uniform_wind));
    const auto error_of = [&](const Dealiased& dealiased, const WindProfileOptions& options) {
        const auto layers = wind_profile(folded.volume, dealiased, options);
        return layers ? std::string{} : layers.error().message;
    };
    const Dealiased right = dealias(folded.volume, Dealiasing::off);
    EXPECT_EQ(error_of(right, {}), "");
    EXPECT_NE(error_of({}, {}), "");
    Dealiased shorter = right;
    shorter.sweeps[0].folds.pop_back();
    EXPECT_NE(error_of(shorter, {}), "");
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    for (const WindProfileOptions& wrong : {WindProfileOptions{.layer_m = 0},
                                            {.layer_m = none},
                                            {.top_m = 1e9},
                                            {.top_m = none},
                                            {.least_range_m = -1},
                                            {.most_range_m = 1000},
                                            {.most_range_m = none}})
        EXPECT_NE(error_of(right, wrong), "");
}

TEST(WindProfile, LayersFollowTheOptions) {
    const FoldedVolume folded = fold(full_volume(20), seen_everywhere(uniform_wind));
    const Layers layers =
        profile_of(folded.volume, Dealiasing::anchored, {.layer_m = 500, .top_m = 3'100});
    ASSERT_EQ(layers.size(), 7U);
    EXPECT_EQ(layers[6].bottom_m, 3'000);
    EXPECT_EQ(layers[6].top_m, 3'500);
    EXPECT_EQ(layers_with_wind(layers), 7U);
}

}  // namespace
}  // namespace stormcellar::retrieve
