// Compares rain rates with values computed by hand from the published relations.
#include "stormcellar/retrieve/rain_rate.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace stormcellar::retrieve {
namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

TEST(RainRate, FollowsTheDefaultRelationUpToTheHailCap) {
    EXPECT_NEAR(rain_by_reflectivity_mm_per_h(10 * std::log10(300)), 1, 1e-12);
    EXPECT_NEAR(rain_by_reflectivity_mm_per_h(40), 12.24, 0.01);
    EXPECT_NEAR(rain_by_reflectivity_mm_per_h(53), 103.8, 0.1);  // the usual cap of NEXRAD
    EXPECT_EQ(rain_by_reflectivity_mm_per_h(70), rain_by_reflectivity_mm_per_h(53));
    EXPECT_LT(rain_by_reflectivity_mm_per_h(-30), 1e-3);
    EXPECT_TRUE(std::isnan(rain_by_reflectivity_mm_per_h(no_number)));
}

TEST(RainRate, FollowsKdp) {
    EXPECT_NEAR(rain_by_kdp_mm_per_h(1), 44, 1e-12);
    EXPECT_NEAR(rain_by_kdp_mm_per_h(2), 77.8, 0.1);
    EXPECT_EQ(rain_by_kdp_mm_per_h(-1), 0);
    EXPECT_TRUE(std::isnan(rain_by_kdp_mm_per_h(no_number)));
}

TEST(RainRate, TakesKdpInHeavyRainIfItIsSure) {
    EXPECT_EQ(rain_rate_mm_per_h(60, 2, 0.1), rain_by_kdp_mm_per_h(2));
    const double by_reflectivity = rain_by_reflectivity_mm_per_h(45);
    EXPECT_EQ(rain_rate_mm_per_h(45, 0.4, 0.01), by_reflectivity) << "weak";
    EXPECT_EQ(rain_rate_mm_per_h(45, 1, 0.3), by_reflectivity) << "uncertain";
    EXPECT_EQ(rain_rate_mm_per_h(45, no_number, no_number), by_reflectivity) << "no KDP";
    EXPECT_EQ(rain_rate_mm_per_h(35, 2, 0.1), rain_by_reflectivity_mm_per_h(35)) << "weak echo";
    EXPECT_TRUE(std::isnan(rain_rate_mm_per_h(no_number, 2, 0.1)));
}

}  // namespace
}  // namespace stormcellar::retrieve
