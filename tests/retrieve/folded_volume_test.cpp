// Tests the volumes with which other tests judge retrievals.
#include "tests/retrieve/folded_volume.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace stormcellar::retrieve {
namespace {

const synth::Wind strong_wind{{{0, {30, 0}}, {5000, {60, 20}}}};

// Compares raw + 2 n nyquist with the truth; returns the largest difference.
double largest_error_mps(const FoldedSpec& spec, const FoldedVolume& folded) {
    double largest = 0;
    for (std::size_t s = 0; s < folded.folds.size(); ++s) {
        const level2::SweepMoment& moment = folded.volume.sweeps[s].moments[0];
        for (std::size_t i = 0; i < folded.folds[s].size(); ++i) {
            if (std::isnan(folded.true_mps[s][i])) continue;
            const double unfolded_mps =
                moment.value_of(moment.codes8[i]) + 2 * spec.nyquist_mps * folded.folds[s][i];
            largest = std::max(largest, std::abs(unfolded_mps - folded.true_mps[s][i]));
        }
    }
    return largest;
}

TEST(FoldedVolume, UnfoldsToTheTruth) {
    for (const double nyquist_mps : {8.0, 11.6, 33.0}) {
        FoldedSpec spec;
        spec.nyquist_mps = nyquist_mps;
        spec.noise_mps = 0;
        EXPECT_LE(largest_error_mps(spec, fold(spec, strong_wind)), 0.2501) << "half a code";
        spec.noise_mps = 1;
        EXPECT_LE(largest_error_mps(spec, fold(spec, strong_wind)), 6.8 + 0.2501);
    }
}

TEST(FoldedVolume, GatesAreMissingOrSpeckleAtRandom) {
    FoldedSpec spec;
    spec.missing = 0.2;
    spec.speckle = 0.1;
    const FoldedVolume folded = fold(spec, strong_wind);
    double gates = 0, missing = 0, speckle = 0;
    for (std::size_t s = 0; s < folded.folds.size(); ++s) {
        for (std::size_t i = 0; i < folded.folds[s].size(); ++i) {
            const bool shown = folded.volume.sweeps[s].moments[0].codes8[i] >= 2;
            const bool known = !std::isnan(folded.true_mps[s][i]);
            ASSERT_TRUE(shown || !known);
            ++gates;
            missing += shown ? 0 : 1;
            speckle += shown && !known ? 1 : 0;
        }
    }
    EXPECT_EQ(gates, 5 * 360 * 400);
    EXPECT_NEAR(missing / gates, 0.2, 0.002);
    EXPECT_NEAR(speckle / gates, 0.8 * 0.1, 0.002);
}

TEST(FoldedVolume, DependsOnItsSeedAlone) {
    FoldedSpec spec;
    spec.elevations_deg = {0.5};
    const auto codes = [&] { return fold(spec, strong_wind).volume.sweeps[0].moments[0].codes8; };
    const auto first = codes();
    EXPECT_EQ(codes(), first);
    spec.seed = 2;
    EXPECT_NE(codes(), first);
}

}  // namespace
}  // namespace stormcellar::retrieve
