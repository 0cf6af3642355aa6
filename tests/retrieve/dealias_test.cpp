// Tests dealias() with folded winds whose true radial velocity is known at every gate, and with odd
// volumes.
#include "stormcellar/retrieve/dealias.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <gtest/gtest.h>

#include "tests/retrieve/folded_volume.h"

namespace stormcellar::retrieve {
namespace {

const synth::Wind uniform{{{0, {18, 22}}}};
// The wind turns from 8 m/s from the south at the antenna to 45 m/s from the west at 8 km.
const synth::Wind sheared{{{0, {0, 8}}, {8000, {45, 0}}}};
// A Rankine vortex of 50 m/s at 10 km from its center, 45 km east of the radar, in a wind of 10
// m/s.
const synth::Wind vortex{{{0, {10, 0}}},
                         {{.x_m = 45'000, .radius_m = 10'000, .tangential_mps = 50}}};

class SyntheticWind : public ::testing::TestWithParam<double> {};

// At every Nyquist velocity, 99.9 % of the gates must be right, and no sweep may be wrong as a
// whole.
TEST_P(SyntheticWind, IsUnfolded) {
    for (const auto& [name, wind] : {std::pair{"uniform", &uniform}, std::pair{"sheared", &sheared},
                                     std::pair{"vortex", &vortex}}) {
        FoldedSpec spec;
        spec.nyquist_mps = GetParam();
        const FoldedVolume folded = fold(spec, *wind);
        const Score found = score(folded, dealias(folded.volume, Dealiasing::anchored));
        EXPECT_GT(found.gates, 600'000);
        EXPECT_LE(found.wrong_share(), 0.001) << name;
        EXPECT_LE(found.worst_sweep, 0.005) << name;
    }
}

// A tenth of the gates holds random velocities. At most one in 10,000 gates of the wind may get a
// wrong fold number because of the random velocities.
TEST_P(SyntheticWind, IsUnfoldedBetweenSpeckle) {
    FoldedSpec spec;
    spec.nyquist_mps = GetParam();
    spec.speckle = 0.1;
    const FoldedVolume folded = fold(spec, vortex);
    const Score found = score(folded, dealias(folded.volume, Dealiasing::anchored));
    EXPECT_GT(found.gates, 600'000);
    EXPECT_LT(found.gates, 620'000) << "the score leaves speckle out";
    EXPECT_LE(found.wrong_share(), 0.0001);
}
// 2026-11-29: gates whose only neighbors were speckle took the fold number of the speckle; these
// were up to 0.9 % of the gates.
TEST_P(SyntheticWind, IsUnfoldedBetweenSpeckleAndGaps) {
    FoldedSpec spec;
    spec.nyquist_mps = GetParam();
    spec.missing = 0.3;
    spec.speckle = 0.1;
    const FoldedVolume folded = fold(spec, vortex);
    const Score found = score(folded, dealias(folded.volume, Dealiasing::anchored));
    EXPECT_GT(found.gates, 450'000);
    EXPECT_LE(found.wrong_share(), 0.001);
    EXPECT_LE(static_cast<double>(found.wrong_unmarked), 5e-4 * static_cast<double>(found.gates));
}
INSTANTIATE_TEST_SUITE_P(Nyquist, SyntheticWind, ::testing::Values(8.0, 12.0, 16.0, 24.0, 33.0));

// Velocities rise by 24 m/s from north to south on the eastern side, and fall as much on the
// western side. Over 1 km of range, the whole rise is within one radial, so gates of two fold
// numbers look alike there.
double linked_sides(double azimuth_deg, double range_m, double, double) {
    const bool is_sharp = range_m >= 25'000 && range_m < 26'000;
    const double east = std::clamp((azimuth_deg - 90) / (is_sharp ? 0.5 : 8) + 0.5, 0.0, 1.0);
    const double west = std::clamp((azimuth_deg - 270) / 16 + 0.5, 0.0, 1.0);
    return -9 + 24 * (east - west);
}
// 2026-11-30: a few linked gates gave half of the sweep a wrong fold number, as in the hurricane of
// KCRP 2017 after its velocities were folded again at 12 m/s.
TEST(Dealias, AFewGatesOfStrongShearDoNotFoldBothSides) {
    FoldedSpec spec;
    spec.elevations_deg = {0.5};
    const FoldedVolume folded = fold(spec, linked_sides);
    for (const Dealiasing rung : {Dealiasing::region, Dealiasing::anchored}) {
        const Score found = score(folded, dealias(folded.volume, rung));
        EXPECT_GT(found.gates, 130'000);
        EXPECT_LE(found.wrong_share(), 0.001) << dealiasing_name(rung);
        EXPECT_LE(found.marked, found.gates / 100) << dealiasing_name(rung);
    }
}

// Two storms with no echo between them: only the wind can show how often the far storm is folded.
TEST(Dealias, AnIsolatedStormIsAnchoredToTheWind) {
    const RadialVelocity wind = along_beam(uniform);
    const auto storms = [&](double azimuth, double range, double elevation, double height) {
        const bool is_near = range < 30'000;
        const bool is_far = azimuth > 40 && azimuth < 70 && range > 70'000 && range < 90'000;
        if (!is_near && !is_far) return std::numeric_limits<double>::quiet_NaN();
        return wind(azimuth, range, elevation, height);
    };
    FoldedSpec spec;
    spec.nyquist_mps = 10;
    spec.elevations_deg = {0.5, 1.0, 1.5, 2.0};
    const FoldedVolume folded = fold(spec, storms);
    const Score anchored = score(folded, dealias(folded.volume, Dealiasing::anchored));
    const Score alone = score(folded, dealias(folded.volume, Dealiasing::region));
    EXPECT_LE(anchored.wrong_share(), 0.001);
    EXPECT_GT(alone.wrong_share(), 0.05) << "neighbors alone cannot show the fold number";
}

TEST(Dealias, OffLeavesEveryGateAsItIs) {
    const FoldedVolume folded = fold({}, uniform);
    const Dealiased found = dealias(folded.volume, Dealiasing::off);
    ASSERT_EQ(found.sweeps.size(), 5U);
    for (const SweepFolds& sweep : found.sweeps)
        for (const std::int8_t fold : sweep.folds)
            ASSERT_EQ(fold, 0);
}

TEST(Dealias, NothingFoldedStaysAsItIs) {
    FoldedSpec spec;
    spec.nyquist_mps = 60;
    const FoldedVolume folded = fold(spec, uniform);
    for (const Dealiasing rung : {Dealiasing::profile, Dealiasing::region, Dealiasing::anchored}) {
        const Dealiased found = dealias(folded.volume, rung);
        EXPECT_EQ(score(folded, found).wrong, 0) << static_cast<int>(rung);
        EXPECT_EQ(found.folded_gates, 0);
        EXPECT_EQ(found.ambiguous_gates, 0) << static_cast<int>(rung);
    }
}

// 2026-11-29: `region` marked a sweep of one region, about which no neighbor votes.
TEST(Dealias, TheMainEchoIsNoGuessButEchoOnItsOwnIs) {
    const auto main_echo = [](double azimuth, double range, double, double) {
        const bool is_main = azimuth > 90 && azimuth < 270 && range < 60'000;
        const bool is_alone = azimuth > 350 && range > 90'000;
        return is_main ? 5.0 : is_alone ? -5.0 : std::numeric_limits<double>::quiet_NaN();
    };
    FoldedSpec spec;
    spec.nyquist_mps = 40;
    spec.missing = 0;
    spec.elevations_deg = {0.5};
    const FoldedVolume folded = fold(spec, main_echo);
    const Dealiased found = dealias(folded.volume, Dealiasing::region);
    EXPECT_EQ(found.folded_gates, 0);
    ASSERT_GT(found.gates, 40'000);
    const auto gates = static_cast<std::size_t>(spec.gates);
    for (std::size_t i = 0; i < found.sweeps[0].folds.size(); ++i) {
        if (folded.volume.sweeps[0].moments[0].codes8[i] < 2) continue;
        ASSERT_EQ(found.sweeps[0].ambiguous[i], i / gates > 340 ? 1 : 0) << i;
    }
}

TEST(Dealias, OddVolumesAreNoTrouble) {
    FoldedSpec legacy = one_legacy_sweep_spec();
    legacy.gates = 60;
    for (const Dealiasing rung : {Dealiasing::profile, Dealiasing::region, Dealiasing::anchored}) {
        EXPECT_EQ(dealias({}, rung).sweeps.size(), 0U);
        EXPECT_EQ(dealias(fold(one_gate_spec(), uniform).volume, rung).gates, 5)
            << "each sweep has one gate";
        EXPECT_GT(dealias(fold(legacy, scattered_mps).volume, rung).gates, 0);
        FoldedVolume folded = fold({}, uniform);
        for (level2::Radial& radial : folded.volume.sweeps[0].radials)
            radial.nyquist_mps = 0;
        folded.volume.sweeps[1].radials[100].nyquist_mps = std::numeric_limits<float>::quiet_NaN();
        folded.volume.sweeps[2].radials[7].azimuth_deg = std::numeric_limits<float>::infinity();
        folded.volume.sweeps[3].moments[0].first_gate_m = -375;
        for (std::size_t radial = 180; radial < 360; ++radial)
            folded.volume.sweeps[4].radials[radial].nyquist_mps = 17;
        const Dealiased found = dealias(folded.volume, rung);
        for (const std::int8_t fold : found.sweeps[0].folds)
            ASSERT_EQ(fold, 0) << "radials without a Nyquist velocity are not unfolded";
    }
}

}  // namespace
}  // namespace stormcellar::retrieve
