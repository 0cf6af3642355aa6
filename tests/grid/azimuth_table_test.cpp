#include "grid/sweep/azimuth_table.h"

#include <cmath>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

namespace stormcellar::grid {
namespace {

double turn(double a_deg, double b_deg) {
    const double step_deg = std::abs(a_deg - b_deg);
    return std::min(step_deg, 360 - step_deg);
}

// Finds the nearest radial by brute force, or the later radial if two are equally near. A radial
// farther than half a spacing counts only if its neighbor on the other side of the azimuth is
// within 1.5 spacings of the radial. Sets `margin_deg` to how close the decision is.
int slow_find(const std::vector<float>& azimuths_deg, double spacing_deg, double azimuth_deg,
              double& margin_deg) {
    int left = -1;
    int right = -1;
    double left_deg = 1e9;
    double right_deg = 1e9;
    for (int i = static_cast<int>(azimuths_deg.size()) - 1; i >= 0; --i) {
        const double ahead =
            std::fmod(static_cast<double>(azimuths_deg[i]) - azimuth_deg + 720, 360);
        const double behind =
            std::fmod(azimuth_deg - static_cast<double>(azimuths_deg[i]) + 720, 360);
        if (ahead < right_deg) right = i, right_deg = ahead;
        if (behind < left_deg) left = i, left_deg = behind;
    }
    margin_deg = 1e9;
    if (left < 0) return AzimuthTable::none;
    const double nearest_deg = std::min(left_deg, right_deg);
    const bool gap = left_deg + right_deg > 1.5 * spacing_deg;
    margin_deg = gap ? std::abs(nearest_deg - spacing_deg / 2) : std::abs(left_deg - right_deg);
    if (gap && nearest_deg > spacing_deg / 2) return AzimuthTable::none;
    return left_deg < right_deg ? left : right;
}

void expect_same_as_slow(const std::vector<float>& azimuths_deg, double spacing_deg) {
    const AzimuthTable table(azimuths_deg, spacing_deg);
    std::mt19937 random(11);
    std::uniform_real_distribution<float> azimuth(0, 360);
    int compared = 0;
    for (int i = 0; i < 20000; ++i) {
        float at_deg = azimuth(random);
        if (at_deg >= 360) continue;
        if (i < 1440) at_deg = static_cast<float>(i) / 4;  // the borders of the bins
        double margin_deg = 0;
        const int expected =
            slow_find(azimuths_deg, spacing_deg, static_cast<double>(at_deg), margin_deg);
        if (margin_deg < 1e-4) continue;
        ++compared;
        ASSERT_EQ(table.find(at_deg), expected) << at_deg;
    }
    EXPECT_GT(compared, 18000);
}

std::vector<float> regular(int count, float first, float step) {
    std::vector<float> azimuths_deg;
    azimuths_deg.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i)
        azimuths_deg.push_back(std::fmod(first + step * static_cast<float>(i), 360.0F));
    return azimuths_deg;
}

TEST(AzimuthTable, FindsTheNearestRadial) {
    expect_same_as_slow(regular(720, 0.25F, 0.5F), 0.5);
    expect_same_as_slow(regular(360, 187.3F, 1), 1);
}

TEST(AzimuthTable, JitteringLegacyRadialsThatOverlapThemselves) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> jitter(-0.2F, 0.2F);
    for (const int count : {336, 360, 368}) {
        std::vector<float> azimuths_deg = regular(count, 355, 360.0F / 361);
        for (float& azimuth_deg : azimuths_deg)
            azimuth_deg = std::fmod(azimuth_deg + jitter(random) + 360, 360.0F);
        expect_same_as_slow(azimuths_deg, 1);
    }
}

TEST(AzimuthTable, GapsAreSeenByNone) {
    std::vector<float> azimuths_deg = regular(360, 0.5F, 1);
    azimuths_deg.erase(azimuths_deg.begin() + 100, azimuths_deg.begin() + 200);
    expect_same_as_slow(azimuths_deg, 1);
    const AzimuthTable table(azimuths_deg, 1);
    EXPECT_EQ(table.find(99.9F), 99);
    EXPECT_EQ(table.find(100.1F), AzimuthTable::none);
    EXPECT_EQ(table.find(199.9F), AzimuthTable::none);
    EXPECT_EQ(table.find(200.1F), 100);
}

TEST(AzimuthTable, AGapAcrossNorth) {
    std::vector<float> azimuths_deg = regular(300, 30.5F, 1);  // 30 to 330 degrees
    expect_same_as_slow(azimuths_deg, 1);
    const AzimuthTable table(azimuths_deg, 1);
    EXPECT_EQ(table.find(0), AzimuthTable::none);
    EXPECT_EQ(table.find(359.99F), AzimuthTable::none);
}

TEST(AzimuthTable, WrapsAtNorth) {
    const AzimuthTable table(regular(360, 0, 1), 1);
    EXPECT_EQ(table.find(0), 0);
    EXPECT_EQ(table.find(0.49F), 0);
    EXPECT_EQ(table.find(359.51F), 0);
    EXPECT_EQ(table.find(359.49F), 359);
    EXPECT_EQ(table.find(std::nextafter(360.0F, 0.0F)), 0);
}

TEST(AzimuthTable, OfDuplicatesTheLaterCounts) {
    const std::vector<float> azimuths_deg = {10, 11, 12, 11};
    EXPECT_EQ(AzimuthTable(azimuths_deg, 1).find(11), 3);
}

TEST(AzimuthTable, AnyOrder) {
    const std::vector<float> azimuths_deg = {12, 10, 11};
    const AzimuthTable table(azimuths_deg, 1);
    EXPECT_EQ(table.find(10), 1);
    EXPECT_EQ(table.find(11), 2);
    EXPECT_EQ(table.find(12), 0);
}

TEST(AzimuthTable, OneRadialReachesHalfASpacing) {
    for (const float at_deg : {0.0F, 0.2F, 90.0F, 359.8F}) {
        const std::vector<float> azimuths_deg = {at_deg};
        const AzimuthTable table(azimuths_deg, 1);
        for (int i = 0; i < 1200; ++i) {
            const float azimuth_deg = static_cast<float>(i) * 0.3F;
            const double away_deg =
                turn(static_cast<double>(azimuth_deg), static_cast<double>(at_deg));
            if (std::abs(away_deg - 0.5) < 1e-4) continue;
            EXPECT_EQ(table.find(azimuth_deg), away_deg < 0.5 ? 0 : AzimuthTable::none);
        }
    }
}

TEST(AzimuthTable, NoRadials) {
    const AzimuthTable table({}, 1);
    EXPECT_EQ(table.find(0), AzimuthTable::none);
    EXPECT_EQ(table.find(200), AzimuthTable::none);
}

}  // namespace
}  // namespace stormcellar::grid
