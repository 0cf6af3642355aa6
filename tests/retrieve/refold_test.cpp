// Tests that velocities folded again at a lower Nyquist velocity keep their true velocity, and that
// scores and jumps are counted as stated.
#include "retrieve/judge/refold.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/retrieve/folded_volume.h"

namespace stormcellar::retrieve {
namespace {

// A volume with a wind of 40 m/s, whose fold numbers at 26.17 m/s are known.
KnownVolume known_volume() {
    FoldedSpec spec;
    spec.nyquist_mps = 26.17;
    spec.elevations_deg = {0.5, 2.5};
    spec.gates = 60;
    const FoldedVolume folded = fold(spec, {{{0, {24, 32}}}});
    KnownVolume known{folded.volume, dealias(folded.volume, Dealiasing::off).sweeps};
    for (std::size_t i = 0; i < known.folds.size(); ++i)
        known.folds[i].folds = folded.folds[i];
    return known;
}

// Returns the unfolded velocity of each gate, and NaN for gates without one.
std::vector<double> velocities(const KnownVolume& known) {
    std::vector<double> found;
    for (const SweepFolds& folds : known.folds) {
        const level2::Sweep& sweep = known.volume.sweeps[folds.sweep];
        const level2::SweepMoment& moment = sweep.moments[folds.moment];
        for (std::size_t radial = 0; radial < sweep.radials.size(); ++radial) {
            for (std::int32_t gate = 0; gate < moment.gate_stride; ++gate) {
                const double raw = moment.status(radial, gate) == level2::GateStatus::valid
                                       ? moment.value_of(moment.code(radial, gate))
                                       : std::numeric_limits<double>::quiet_NaN();
                found.push_back(
                    raw + 2.0 * sweep.radials[radial].nyquist_mps *
                              folds.folds[radial * static_cast<std::size_t>(moment.gate_stride) +
                                          static_cast<std::size_t>(gate)]);
            }
        }
    }
    return found;
}

void expect_same_velocities(const KnownVolume& a, const KnownVolume& b) {
    const std::vector<double> of_a = velocities(a), of_b = velocities(b);
    ASSERT_EQ(of_a.size(), of_b.size());
    std::size_t values = 0;
    for (std::size_t i = 0; i < of_a.size(); ++i) {
        ASSERT_EQ(std::isnan(of_a[i]), std::isnan(of_b[i])) << i;
        if (std::isnan(of_a[i])) continue;
        ++values;
        ASSERT_NEAR(of_a[i], of_b[i], 0.0051) << i;
    }
    EXPECT_GT(values, 30'000U);
}

TEST(Refold, AtTheRealNyquistVelocityNothingChanges) {
    const KnownVolume known = known_volume();
    const auto again = refold(known, known.volume.sweeps[0].radials[0].nyquist_mps);
    ASSERT_TRUE(again) << again.error().message;
    for (std::size_t i = 0; i < known.folds.size(); ++i) {
        EXPECT_EQ(again->folds[i].folds, known.folds[i].folds);
        EXPECT_EQ(again->folds[i].ambiguous, known.folds[i].ambiguous);
    }
    expect_same_velocities(known, *again);
}

TEST(Refold, KeepsRawPlusTwoNTimesNyquist) {
    const KnownVolume known = known_volume();
    double fastest_mps = 0;
    for (const double velocity_mps : velocities(known))
        fastest_mps = std::fmax(fastest_mps, std::abs(velocity_mps));
    EXPECT_GT(fastest_mps, 40);
    for (const double nyquist_mps : {20.0, 16.0, 12.0, 8.5}) {
        const auto again = refold(known, nyquist_mps);
        ASSERT_TRUE(again) << again.error().message;
        expect_same_velocities(known, *again);
        int most = 0;
        for (const SweepFolds& folds : again->folds) {
            const level2::Sweep& sweep = again->volume.sweeps[folds.sweep];
            EXPECT_FLOAT_EQ(sweep.radials[0].nyquist_mps, static_cast<float>(nyquist_mps));
            const level2::SweepMoment& moment = sweep.moments[folds.moment];
            for (std::int32_t gate = 0; gate < moment.gate_stride; ++gate) {
                if (moment.status(0, gate) != level2::GateStatus::valid) continue;
                EXPECT_LE(std::abs(moment.value_of(moment.code(0, gate))), nyquist_mps + 0.0051);
            }
            for (const std::int8_t fold : folds.folds)
                most = std::max<int>(most, std::abs(fold));
        }
        EXPECT_EQ(most, std::lround(fastest_mps / (2 * nyquist_mps)));
    }
}

// If radials were folded at a lower Nyquist velocity, their velocities at a higher Nyquist velocity
// are unknown.
TEST(Refold, RadialsOfALowerNyquistVelocityAreUnknown) {
    KnownVolume known = known_volume();
    known.volume.sweeps[0].radials[7].nyquist_mps = 10;
    known.volume.sweeps[0].radials[8].nyquist_mps = 0;
    const auto again = refold(known, 16);
    ASSERT_TRUE(again);
    const SweepFolds& folds = again->folds[0];
    const level2::Sweep& sweep = again->volume.sweeps[0];
    const auto gates = static_cast<std::size_t>(sweep.moments[0].gate_stride);
    for (std::size_t radial = 6; radial < 10; ++radial) {
        for (std::size_t gate = 0; gate < gates; ++gate)
            EXPECT_EQ(folds.ambiguous[radial * gates + gate], radial == 7 || radial == 8 ? 1 : 0);
    }
    EXPECT_FLOAT_EQ(sweep.radials[6].nyquist_mps, 16);
    EXPECT_FLOAT_EQ(sweep.radials[7].nyquist_mps, 10);
    EXPECT_FLOAT_EQ(sweep.radials[8].nyquist_mps, 0);
}

TEST(Refold, RefusesBadNyquistVelocitiesAndFoldsOfAnotherVolume) {
    KnownVolume known = known_volume();
    for (const double bad : {0.0, -8.0, 0.9, 201.0, std::numeric_limits<double>::quiet_NaN()})
        EXPECT_FALSE(refold(known, bad)) << bad;
    known.folds.pop_back();
    EXPECT_FALSE(refold(known, 12));
    EXPECT_TRUE(refold({}, 12)) << "a volume without velocities has nothing to fold";
}

TEST(Refold, ScoresCountWrongAndMarkedGates) {
    const KnownVolume known = known_volume();
    Dealiased found;
    found.sweeps = known.folds;
    const FoldScore right = score_folds(known, found);
    EXPECT_GT(right.gates, 30'000);
    EXPECT_EQ(right.known, right.gates);
    EXPECT_EQ(right.wrong, 0);
    EXPECT_EQ(right.ambiguous_share(), 0);
    // The first two gates with a velocity are wrong, and the first of them is marked.
    const level2::SweepMoment& moment = known.volume.sweeps[0].moments[0];
    int changed = 0;
    for (std::int32_t gate = 0; changed < 2; ++gate) {
        if (moment.status(0, gate) != level2::GateStatus::valid) continue;
        found.sweeps[0].folds[static_cast<std::size_t>(gate)] += 1;
        found.sweeps[0].ambiguous[static_cast<std::size_t>(gate)] = changed == 0 ? 1 : 0;
        ++changed;
    }
    const FoldScore score = score_folds(known, found);
    EXPECT_EQ(score.wrong, 2);
    EXPECT_EQ(score.ambiguous, 1);
    EXPECT_EQ(score.known_unmarked, score.known - 1);
    EXPECT_EQ(score.wrong_unmarked, 1);
    EXPECT_DOUBLE_EQ(score.wrong_share(), 2.0 / static_cast<double>(score.known));
    EXPECT_EQ(FoldScore{}.wrong_share() + FoldScore{}.wrong_unmarked_share(), 0);
}

TEST(Refold, OneWrongGateJumpsToItsNeighbors) {
    KnownVolume known = known_volume();
    Dealiased found;
    found.sweeps = known.folds;
    EXPECT_EQ(count_jumps(known.volume, found), 0);
    const level2::SweepMoment& moment = known.volume.sweeps[0].moments[0];
    const auto valid = [&](std::size_t radial, std::int32_t gate) {
        return moment.status(radial, gate) == level2::GateStatus::valid;
    };
    std::int32_t gate = 1;
    while (!valid(5, gate - 1) || !valid(5, gate) || !valid(5, gate + 1) || !valid(4, gate) ||
           !valid(6, gate))
        ++gate;
    found.sweeps[0]
        .folds[5 * static_cast<std::size_t>(moment.gate_stride) + static_cast<std::size_t>(gate)] +=
        1;
    EXPECT_EQ(count_jumps(known.volume, found), 4);
}

}  // namespace
}  // namespace stormcellar::retrieve
