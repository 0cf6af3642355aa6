#include "synth/vcp.h"

#include <gtest/gtest.h>

namespace stormcellar::synth {
namespace {

TEST(SynthVcp, ThePatternsTakeAsLongAsTheRadars) {
    // Real volumes take these minutes from the first radial to the last.
    EXPECT_NEAR(duration_s(*find_pattern(212)) / 60, 4.7, 0.15);
    EXPECT_NEAR(duration_s(*find_pattern(215)) / 60, 6.1, 0.15);
    EXPECT_NEAR(duration_s(*find_pattern(35)) / 60, 7.2, 0.15);
    EXPECT_EQ(find_pattern(11), nullptr);
    for (const int number : pattern_numbers())
        EXPECT_EQ(find_pattern(number)->number, number);
}

TEST(SynthVcp, SplitCutsLookTwiceAtTheLowAngles) {
    const Pattern& pattern = *find_pattern(212);
    ASSERT_EQ(pattern.cuts.size(), 17U);
    for (std::size_t i = 0; i < 6; i += 2) {
        EXPECT_EQ(pattern.cuts[i].waveform, Waveform::surveillance);
        EXPECT_EQ(pattern.cuts[i + 1].waveform, Waveform::doppler);
        EXPECT_EQ(pattern.cuts[i].elevation_deg, pattern.cuts[i + 1].elevation_deg);
        EXPECT_FALSE(has_velocity(pattern.cuts[i]));
        EXPECT_TRUE(has_velocity(pattern.cuts[i + 1]));
        EXPECT_GT(unambiguous_range_m(pattern.cuts[i]), 400e3);
        EXPECT_GT(nyquist_mps(pattern.cuts[i + 1]), 20);
    }
}

TEST(SynthVcp, MessageFiveSaysTheSameCuts) {
    const Pattern& pattern = *find_pattern(215);
    const level2::Vcp vcp = to_message(pattern);
    EXPECT_EQ(vcp.pattern_number, 215);
    ASSERT_EQ(vcp.cuts.size(), pattern.cuts.size());
    for (std::size_t i = 0; i < vcp.cuts.size(); ++i) {
        EXPECT_EQ(vcp.cuts[i].elevation_deg, pattern.cuts[i].elevation_deg);
        EXPECT_EQ(vcp.cuts[i].waveform, static_cast<int>(pattern.cuts[i].waveform));
        EXPECT_EQ(vcp.cuts[i].azimuth_rate_code * 22.5 / 16384, pattern.cuts[i].azimuth_rate_deg_s);
    }
}

}  // namespace
}  // namespace stormcellar::synth
