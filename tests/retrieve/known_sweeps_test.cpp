// Tests that sweeps that are already dealiased help to dealias other sweeps. The known sweeps are
// those of the volume before, or of the same volume while it grows.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "stormcellar/level2/decode.h"
#include "stormcellar/retrieve/dealias.h"
#include "tests/retrieve/folded_volume.h"
#include "tests/testing/data.h"

namespace stormcellar::retrieve {
namespace {

using level2::Moment;

constexpr double silence = std::numeric_limits<double>::quiet_NaN();
constexpr double calm_mps = 4, storm_mps = 25;

// A storm between 40 and 70 degrees of azimuth from 60 to 90 km. Returns 1 inside it, falling to 0
// within 10 km and 10 degrees.
double inside_storm(double azimuth_deg, double range_m) {
    const double beside = std::max({40 - azimuth_deg, azimuth_deg - 70, 0.0}) / 10;
    const double beyond = std::max({60'000 - range_m, range_m - 90'000, 0.0}) / 10'000;
    return std::clamp(1 - std::hypot(beside, beyond), 0.0, 1.0);
}
double storm_in_rain(double azimuth_deg, double range_m, double /*elevation*/, double /*height*/) {
    return calm_mps + (storm_mps - calm_mps) * inside_storm(azimuth_deg, range_m);
}
// The rain about the storm has gone, so nothing connects the storm with the echo near the radar.
double storm_alone(double azimuth_deg, double range_m, double /*elevation*/, double /*height*/) {
    if (range_m < 10'000) return calm_mps;
    return inside_storm(azimuth_deg, range_m) < 1 ? silence : storm_mps;
}

constexpr UtcTime start{std::chrono::hours{400'000}};

FoldedVolume folded_at(std::chrono::minutes after, const RadialVelocity& velocity,
                       FoldedSpec spec = {}) {
    spec.nyquist_mps = 10;
    spec.elevations_deg = {0.5, 1.0, 1.5, 2.0};
    FoldedVolume folded = fold(spec, velocity);
    for (level2::Sweep& sweep : folded.volume.sweeps)
        for (level2::Radial& radial : sweep.radials)
            radial.time = start + after;
    return folded;
}

std::vector<level2::Sweep> dealiased_sweeps(FoldedVolume folded) {
    EXPECT_TRUE(add_dealiased_velocity(folded.volume, Dealiasing::anchored));
    return std::move(folded.volume.sweeps);
}

Score score_with(const FoldedVolume& folded, std::span<const level2::Sweep> known) {
    return score(folded, dealias(folded.volume, Dealiasing::anchored, known));
}

// Alone, the storm is folded as a whole, and is not marked.
TEST(KnownSweeps, TheVolumeBeforeUnfoldsAStormThatHasBecomeIsolated) {
    const auto before = dealiased_sweeps(folded_at(std::chrono::minutes{0}, storm_in_rain));
    const FoldedVolume now = folded_at(std::chrono::minutes{5}, storm_alone);
    const Score alone = score_with(now, {}), with = score_with(now, before);
    EXPECT_GT(alone.wrong_share(), 0.2) << "all gates of the storm";
    EXPECT_GT(alone.wrong_unmarked, alone.wrong / 2);
    EXPECT_LE(with.wrong_share(), 0.001);
    EXPECT_LE(with.marked, with.gates / 100);
}

TEST(KnownSweeps, MayHaveOtherRadialsAndGates) {
    FoldedSpec coarse;
    coarse.radials = 180;
    coarse.gates = 100;
    coarse.gate_spacing_m = 1000;
    const auto before = dealiased_sweeps(folded_at(std::chrono::minutes{0}, storm_in_rain, coarse));
    const FoldedVolume now = folded_at(std::chrono::minutes{5}, storm_alone);
    EXPECT_LE(score_with(now, before).wrong_share(), 0.001);
}

// Half of the sweeps of the volume before are enough, because each helps the sweeps beside it.
TEST(KnownSweeps, HelpSweepsOfOtherElevations) {
    auto before = dealiased_sweeps(folded_at(std::chrono::minutes{0}, storm_in_rain));
    before = {before[0], before[2]};
    const FoldedVolume now = folded_at(std::chrono::minutes{5}, storm_alone);
    EXPECT_LE(score_with(now, before).wrong_share(), 0.001);
}

// Sweeps leave the result as it is if they are too old or too new, lack VELD, or are ambiguous.
TEST(KnownSweeps, WithoutAVoteChangeNothing) {
    const FoldedVolume now = folded_at(std::chrono::minutes{0}, storm_alone);
    const auto expect_no_change = [&](std::span<const level2::Sweep> known) {
        const Dealiased alone = dealias(now.volume, Dealiasing::anchored);
        const Dealiased with = dealias(now.volume, Dealiasing::anchored, known);
        for (std::size_t i = 0; i < alone.sweeps.size(); ++i) {
            EXPECT_EQ(with.sweeps[i].folds, alone.sweeps[i].folds);
            EXPECT_EQ(with.sweeps[i].ambiguous, alone.sweeps[i].ambiguous);
        }
    };
    expect_no_change(dealiased_sweeps(folded_at(std::chrono::minutes{-16}, storm_in_rain)));
    expect_no_change(dealiased_sweeps(folded_at(std::chrono::minutes{16}, storm_in_rain)));
    expect_no_change(folded_at(std::chrono::minutes{-5}, storm_in_rain).volume.sweeps);
    auto ambiguous = dealiased_sweeps(folded_at(std::chrono::minutes{-5}, storm_in_rain));
    for (level2::Sweep& sweep : ambiguous)
        std::ranges::fill(sweep.moments.back().codes16, std::uint16_t{2});
    expect_no_change(ambiguous);
    auto without_nyquist = dealiased_sweeps(folded_at(std::chrono::minutes{-5}, storm_in_rain));
    for (level2::Sweep& sweep : without_nyquist)
        for (level2::Radial& radial : sweep.radials)
            radial.nyquist_mps = 0;
    expect_no_change(without_nyquist);
}

TEST(KnownSweeps, HaveNoVoteInOtherRungs) {
    const auto before = dealiased_sweeps(folded_at(std::chrono::minutes{0}, storm_in_rain));
    const FoldedVolume now = folded_at(std::chrono::minutes{5}, storm_alone);
    for (const Dealiasing rung : {Dealiasing::off, Dealiasing::profile, Dealiasing::region}) {
        const Dealiased alone = dealias(now.volume, rung), with = dealias(now.volume, rung, before);
        for (std::size_t i = 0; i < alone.sweeps.size(); ++i)
            EXPECT_EQ(with.sweeps[i].folds, alone.sweeps[i].folds);
    }
}

// Dealiases each sweep once, with the sweeps before it, as a growing volume is dealiased.
struct Difference {
    std::int64_t gates = 0, values = 0, marks = 0;
};
Difference sweep_by_sweep(const level2::Volume& volume) {
    level2::Volume whole = volume;
    EXPECT_TRUE(add_dealiased_velocity(whole, Dealiasing::automatic));
    std::vector<level2::Sweep> known;
    Difference difference;
    for (std::size_t s = 0; s < volume.sweeps.size(); ++s) {
        level2::Volume one;
        one.sweeps = {volume.sweeps[s]};
        if (!add_dealiased_velocity(one, Dealiasing::automatic, known)) continue;
        const auto& grown = one.sweeps[0].find(Moment::veld)->codes16;
        const auto& final = whole.sweeps[s].find(Moment::veld)->codes16;
        for (std::size_t i = 0; i < grown.size(); ++i) {
            constexpr std::uint16_t ambiguous = 2;
            if (grown[i] < ambiguous) continue;
            ++difference.gates;
            if (grown[i] == final[i]) continue;
            ++(grown[i] == ambiguous || final[i] == ambiguous ? difference.marks
                                                              : difference.values);
        }
        known.push_back(std::move(one.sweeps[0]));
    }
    return difference;
}

// The last of these volumes shows noisy clear air.
TEST(KnownSweeps, UnfoldARealVolumeSweepBySweepNearlyAsAWhole) {
    STORMCELLAR_NEED_DATA();
    for (const char* name : {"KTLX19990503_235621.gz", "KLIX20050828_180149.gz",
                             "KLBB20160601_150025_V06", "KLOT20220317_000842_V06"}) {
        SCOPED_TRACE(name);
        const auto decoded = level2::decode_file(*testing::data_directory() / "volumes" / name);
        ASSERT_TRUE(decoded) << decoded.error().message;
        const Difference found = sweep_by_sweep(decoded->volume);
        EXPECT_GT(found.gates, 100'000);
        EXPECT_LE(static_cast<double>(found.values), 0.001 * static_cast<double>(found.gates));
        EXPECT_LE(static_cast<double>(found.marks), 0.005 * static_cast<double>(found.gates));
    }
}

}  // namespace
}  // namespace stormcellar::retrieve
