#include "stormcellar/retrieve/hail.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace stormcellar::retrieve {
namespace {

constexpr FreezingLevels plains{4200, 7300};
constexpr float missing = std::numeric_limits<float>::quiet_NaN();

std::vector<double> heights_every(double step_m, double top_m) {
    std::vector<double> heights;
    for (double at = step_m / 2; at < top_m; at += step_m)
        heights.push_back(at);
    return heights;
}

Hail hail_at(const std::vector<double>& heights_m, const std::vector<float>& dbz,
             const FreezingLevels& levels = plains, double radar_m = 0) {
    const auto layers = hail_layers(heights_m, levels, radar_m);
    EXPECT_TRUE(layers) << layers.error().message;
    return layers ? hail_of_column(*layers, dbz) : Hail{};
}

// 60 dBZ from the ground to 12 km: the ramp counts half of its depth, the air above it in full.
TEST(Hail, AConstantColumnHasTheClosedForm) {
    const double flux = 5e-6 * std::pow(10.0, 5.04);
    const double shi = 0.1 * flux * ((7300 - 4200) / 2.0 + (12000 - 7300));
    for (const double step_m : {100.0, 250.0, 500.0, 1000.0}) {
        const auto heights = heights_every(step_m, 12000);
        const Hail hail = hail_at(heights, std::vector<float>(heights.size(), 60));
        EXPECT_NEAR(hail.shi_j_per_m_s, shi, 1e-6 * shi) << step_m;
        EXPECT_NEAR(hail.mesh_mm, 2.54 * std::sqrt(shi), 1e-4) << step_m;
        EXPECT_NEAR(hail.mesh75_mm, 15.096 * std::pow(shi, 0.206), 1e-4) << step_m;
        EXPECT_NEAR(hail.mesh95_mm, 22.157 * std::pow(shi, 0.212), 1e-4) << step_m;
    }
}

float storm_dbz(double height_m) {
    return static_cast<float>(height_m < 5000 ? 58 : 58 - (height_m - 5000) / 400);
}
std::vector<float> storm(const std::vector<double>& heights_m) {
    std::vector<float> dbz;
    for (const double height_m : heights_m)
        dbz.push_back(storm_dbz(height_m));
    return dbz;
}

TEST(Hail, LayersOf500MetersAreFineEnough) {
    const auto fine = heights_every(10, 15000), coarse = heights_every(500, 15000);
    const Hail truth = hail_at(fine, storm(fine)), hail = hail_at(coarse, storm(coarse));
    EXPECT_GT(truth.mesh_mm, 15);
    EXPECT_NEAR(hail.mesh_mm, truth.mesh_mm, 1);
}

TEST(Hail, UnevenHeightsHaveUnevenLayers) {
    // Layers of the heights 8, 9 and 11 km: 1, 1.5 and 2 km deep.
    const Hail hail = hail_at({8000, 9000, 11000}, {55, 55, 55});
    const double flux = 5e-6 * std::pow(10.0, 0.084 * 55);
    EXPECT_NEAR(hail.shi_j_per_m_s, 0.1 * flux * 4500, 1e-3);
}

TEST(Hail, OnlyStrongEchoAboveTheFreezingLevelCounts) {
    const auto heights = heights_every(500, 12000);
    EXPECT_EQ(hail_at(heights, std::vector<float>(heights.size(), 40)).shi_j_per_m_s, 0);
    EXPECT_EQ(hail_at(heights, std::vector<float>(heights.size(), missing)).mesh_mm, 0);
    std::vector<float> warm(heights.size(), missing);
    for (std::size_t i = 0; heights[i] < 3700; ++i)
        warm[i] = 65;
    EXPECT_EQ(hail_at(heights, warm).posh_percent, 0);
    EXPECT_NEAR(hail_energy_flux(45), 5e-6 * std::pow(10.0, 3.78) / 2, 1e-9);
}

TEST(Hail, MissingValuesAddNothing) {
    const auto heights = heights_every(500, 12000);
    auto with_gap = storm(heights), with_echo = with_gap;
    with_gap[20] = missing;
    with_echo[20] = 30;
    EXPECT_EQ(hail_at(heights, with_gap).shi_j_per_m_s, hail_at(heights, with_echo).shi_j_per_m_s);
    EXPECT_LT(hail_at(heights, {with_echo.begin(), with_echo.begin() + 12}).shi_j_per_m_s,
              hail_at(heights, with_echo).shi_j_per_m_s);
    EXPECT_EQ(hail_at(heights, {}).shi_j_per_m_s, 0);
}

TEST(Hail, TheWarningThresholdIsAboveTheRadarAndHasAFloor) {
    const std::vector<double> heights{1000, 2000};
    EXPECT_NEAR(hail_layers(heights, plains, 200)->warning_threshold, 57.5 * 4 - 121, 1e-9);
    EXPECT_EQ(hail_layers(heights, plains, 2000)->warning_threshold, 20);
    EXPECT_FLOAT_EQ(hail_of_shi(109, 109).posh_percent, 50);
    EXPECT_EQ(hail_of_shi(1, 109).posh_percent, 0);
    EXPECT_EQ(hail_of_shi(5000, 109).posh_percent, 100);
}

TEST(Hail, HigherLevelsMakeSmallerHail) {
    const auto heights = heights_every(500, 15000);
    const auto dbz = storm(heights);
    const float size_mm = hail_at(heights, dbz).mesh_mm;
    const auto range = mesh_range(heights, dbz, plains, usual_level_error_m);
    ASSERT_TRUE(range);
    EXPECT_FLOAT_EQ(range->least_mm, hail_at(heights, dbz, {4500, 7600}).mesh_mm);
    EXPECT_FLOAT_EQ(range->most_mm, hail_at(heights, dbz, {3900, 7000}).mesh_mm);
    EXPECT_LT(range->least_mm, size_mm - 1);
    EXPECT_GT(range->most_mm, size_mm + 1);
}

TEST(Hail, RefusesLevelsAndHeightsThatMakeNoSense) {
    const std::vector<double> heights{1000, 2000};
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const FreezingLevels& levels : {FreezingLevels{4200, 4200},
                                         {7300, 4200},
                                         {nan, 7300},
                                         {4200, nan},
                                         {9000, 12000},
                                         {-2000, 1000},
                                         {4.2, 7.3}})
        EXPECT_FALSE(hail_layers(heights, levels, 0)) << levels.zero_c_m;
    EXPECT_TRUE(hail_layers(heights, {-900, 2000}, 0));
    EXPECT_FALSE(hail_layers(std::vector<double>{}, plains, 0));
    EXPECT_FALSE(hail_layers(std::vector<double>{1000}, plains, 0));
    EXPECT_FALSE(hail_layers(std::vector<double>{1000, 1000}, plains, 0));
    EXPECT_FALSE(hail_layers(std::vector<double>{1000, nan}, plains, 0));
    EXPECT_FALSE(hail_layers(heights, plains, nan));
    EXPECT_FALSE(mesh_range(heights, std::vector<float>{60, 60}, plains, -1));
    EXPECT_FALSE(mesh_range(heights, std::vector<float>{60, 60}, plains, nan));
}

TEST(Hail, ExtremeReflectivityStaysFinite) {
    const float infinite = std::numeric_limits<float>::infinity();
    const Hail hail = hail_at({8000, 9000}, {infinite, -infinite});
    EXPECT_FLOAT_EQ(hail.mesh_mm, hail_at({8000, 9000}, {100, 0}).mesh_mm);
    EXPECT_TRUE(std::isfinite(hail.shi_j_per_m_s));
    EXPECT_EQ(hail_of_shi(std::numeric_limits<double>::quiet_NaN(), 20).mesh_mm, 0);
    EXPECT_EQ(hail_of_shi(-1, 20).mesh75_mm, 0);
}

}  // namespace
}  // namespace stormcellar::retrieve
