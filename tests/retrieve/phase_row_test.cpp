// Tests the unfolding of differential phases, and which gates count.
#include "retrieve/kdp/phase_row.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace stormcellar::retrieve {
namespace {

constexpr float no_phase = std::numeric_limits<float>::quiet_NaN();

// Returns a ramp on the circle of 360 degrees.
std::vector<float> wrapped_ramp(std::size_t gates, float first_deg, float step_deg) {
    std::vector<float> phases(gates);
    for (std::size_t gate = 0; gate < gates; ++gate) {
        const float deg = first_deg + step_deg * static_cast<float>(gate);
        phases[gate] = deg - 360 * std::floor(deg / 360);
    }
    return phases;
}

TEST(PhaseRow, FollowsPhasesAroundTheCircleInBothDirections) {
    for (const float step : {3.0F, -3.0F}) {
        const PhaseRow row = unfold_phases(wrapped_ramp(400, 350, step), {});
        for (std::size_t gate = 1; gate < 400; ++gate) {
            ASSERT_EQ(row.is_good[gate], 1) << gate;
            ASSERT_NEAR(row.phases_deg[gate] - row.phases_deg[gate - 1], step, 1e-3) << gate;
        }
    }
}

TEST(PhaseRow, LeavesOutSpeckleAndLowCorrelations) {
    std::vector<float> phases = wrapped_ramp(100, 350, 1);
    std::vector<float> correlations(100, 0.98F);
    phases[30] += 120;  // speckle
    phases[99] = 200;   // at the end
    correlations[50] = 0.7F;
    correlations[51] = no_phase;
    phases[60] = no_phase;
    const PhaseRow row = unfold_phases(phases, correlations);
    for (const std::size_t bad : {30, 50, 51, 60, 99})
        EXPECT_EQ(row.is_good[bad], 0) << bad;
    for (const std::size_t good : {0, 29, 31, 49, 52, 98})
        EXPECT_EQ(row.is_good[good], 1) << good;
    EXPECT_NEAR(row.phases_deg[98] - row.phases_deg[0], 98, 1e-3);
}

TEST(PhaseRow, AFewGatesAloneAreNotGood) {
    std::vector<float> phases(50, no_phase);
    for (const std::size_t gate : {20, 21, 22, 23})
        phases[gate] = 40;
    for (const std::uint8_t good : unfold_phases(phases, {}).is_good)
        EXPECT_EQ(good, 0);
    EXPECT_TRUE(unfold_phases({}, {}).is_good.empty());
}

TEST(PhaseRow, NoiseDoesNotDependOnTheSlope) {
    PhaseRow row{std::vector<double>(200), std::vector<std::uint8_t>(200, 1), {}};
    std::mt19937 random(1);  // NOLINT: the same noise in each run
    std::normal_distribution<double> noise_deg(0, 2);
    for (std::size_t gate = 0; gate < 200; ++gate)  // a ramp with a bend
        row.phases_deg[gate] =
            2 * static_cast<double>(std::min<std::size_t>(gate, 100)) + noise_deg(random);
    for (const double noise : phase_noise_deg(row, 12))
        EXPECT_NEAR(noise, 2, 1);
    const PhaseRow bad{std::vector<double>(9), std::vector<std::uint8_t>(9, 0), {}};
    for (const double noise : phase_noise_deg(bad, 0))
        EXPECT_EQ(noise, 5) << "unknown";
}

}  // namespace
}  // namespace stormcellar::retrieve
