// Simulates color-vision deficiencies and checks that neighboring classes can still be
// distinguished.
#include <algorithm>
#include <array>

#include <gtest/gtest.h>

#include "render/color/built_in_tables.h"
#include "render/color/color_difference.h"
#include "render/color/moment_look.h"

namespace stormcellar::render {
namespace {

struct Sight {
    const char* name;
    double matrix[3][3];  // linear sRGB to linear sRGB
};

// Machado, Oliveira, Fernandes (2009), A physiologically-based model for simulation of color vision
// deficiency, IEEE Transactions on Visualization and Computer Graphics 15(6): severity 1.
constexpr Sight sights[] = {
    {"normal", {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
    {"protanopia",
     {{0.152286, 1.052583, -0.204868},
      {0.114503, 0.786281, 0.099216},
      {-0.003882, -0.048116, 1.051998}}},
    {"deuteranopia",
     {{0.367322, 0.860646, -0.227968},
      {0.280085, 0.672501, 0.047413},
      {-0.011820, 0.042940, 0.968881}}},
    {"tritanopia",
     {{1.255528, -0.076749, -0.178779},
      {-0.078411, 0.930809, 0.147602},
      {0.004733, 0.691367, 0.303900}}},
};

Lab seen_by(const Sight& sight, const Rgba8& color) {
    std::array<double, 3> seen{};
    for (std::size_t row = 0; row < 3; ++row) {
        double sum = 0;
        for (std::size_t c = 0; c < 3; ++c)
            sum += sight.matrix[row][c] * linear_of(color[c]);
        seen[row] = std::clamp(sum, 0.0, 1.0);
    }
    return lab_of_linear(seen[0], seen[1], seen[2]);
}

double least_step(const ColorTable& table, const Sight& sight) {
    double least = 1000;
    for (std::size_t i = 1; i < table.stops.size(); ++i) {
        least = std::min(least, ciede2000(seen_by(sight, table.stops[i - 1].color),
                                          seen_by(sight, table.stops[i].color)));
    }
    return least;
}

bool lightness_rises(const ColorTable& table, std::size_t first, std::size_t end) {
    for (std::size_t i = first + 1; i < end; ++i) {
        if (lab_of(table.stops[i].color).lightness <= lab_of(table.stops[i - 1].color).lightness) {
            return false;
        }
    }
    return true;
}

// Gray stays gray, and `red` and `green` look alike to people who cannot tell red from green.
TEST(Sights, KeepGreysAndMixWhatTheyShould) {
    for (const Sight& sight : sights) {
        EXPECT_LT(ciede2000(seen_by(sight, {128, 128, 128, 255}), lab_of({128, 128, 128, 255})),
                  0.01)
            << sight.name;
    }
    const Rgba8 red = {200, 90, 40, 255};
    const Rgba8 green = {116, 130, 40, 255};
    EXPECT_GT(color_difference(red, green), 30);
    EXPECT_LT(ciede2000(seen_by(sights[2], red), seen_by(sights[2], green)), 12);
}

TEST(SafeTables, NeighboursDifferForEveryKindOfSight) {
    for (const char* name :
         {"safe-reflectivity", "safe-velocity", "safe-zdr", "safe-rho", "height"}) {
        const auto table = find_color_table(name);
        ASSERT_TRUE(table);
        for (const Sight& sight : sights) {
            const double least = least_step(*table, sight);
            EXPECT_GE(least, least_safe_step) << name << " " << sight.name;
            ::testing::Test::RecordProperty(std::string(name) + " " + sight.name,
                                            std::to_string(least));
        }
    }
}

TEST(SafeTables, LightnessRisesWithTheValue) {
    for (const char* name : {"safe-reflectivity", "safe-zdr", "safe-rho", "height"}) {
        const auto table = find_color_table(name);
        ASSERT_TRUE(table);
        EXPECT_TRUE(lightness_rises(*table, 0, table->stops.size())) << name;
    }
}

TEST(SafeTables, VelocityIsLighterWithSpeedAndItsSidesDiffer) {
    ColorTable table = find_color_table("safe-velocity").value();
    const std::size_t count = table.stops.size();
    ASSERT_EQ(count % 2, 1U);
    EXPECT_TRUE(lightness_rises(table, count / 2, count))
        << "velocities away from the radar must get lighter";
    for (const Sight& sight : sights) {
        for (std::size_t i = 0; i < count / 2; ++i) {
            EXPECT_GE(ciede2000(seen_by(sight, table.stops[i].color),
                                seen_by(sight, table.stops[count - 1 - i].color)),
                      least_safe_sides)
                << sight.name << " " << i;
        }
    }
    std::reverse(table.stops.begin(), table.stops.end());
    EXPECT_TRUE(lightness_rises(table, count / 2, count))
        << "velocities toward the radar must get lighter";
}

// Shows that the previous test can fail: the tables of the Weather Service would not pass.
TEST(SafeTables, TheWeatherServicesTablesAreNotSafe) {
    EXPECT_LT(least_step(nws_reflectivity(), sights[1]), 4);
    EXPECT_LT(least_step(nws_reflectivity(), sights[2]), 4);
    EXPECT_FALSE(lightness_rises(nws_reflectivity(), 0, nws_reflectivity().stops.size()));
    const ColorTable velocity = find_color_table("nws-velocity").value();
    double least_sides = 1000;
    for (std::size_t i = 0; i < velocity.stops.size() / 2; ++i) {
        least_sides = std::min(
            least_sides,
            ciede2000(seen_by(sights[2], velocity.stops[i].color),
                      seen_by(sights[2], velocity.stops[velocity.stops.size() - 1 - i].color)));
    }
    EXPECT_LT(least_sides, least_safe_sides);
    EXPECT_LT(least_step(velocity, sights[0]), least_safe_step);
}

// Any two values of a smooth table that are at least `apart` apart must look different to
// everybody. The values of reflectivity avoid the middle of the 1 dB in which a hue changes.
struct FarApart {
    const char* table;
    float from, to, apart, step;
};
constexpr FarApart far_apart[] = {
    {"smooth-reflectivity", 5.5F, 74.5F, 15, 1},
    {"smooth-velocity", -40, 40, 10, 1},
    {"smooth-shear", -20, 20, 5, 0.5F},
    {"smooth-quality", 0, 1, 0.3F, 0.02F},
    {"smooth-kdp", -2, 8, 2, 0.1F},
    {"smooth-rain", 0, 100, 40, 1},
    {"smooth-spectrum-width", 0, 14, 4, 0.25F},
    {"smooth-zdr", -4, 6, 2, 0.1F},
    {"smooth-rho", 0.7F, 1, 0.1F, 0.01F},
    {"smooth-phi", 0, 299, 60, 2},
    {"smooth-cfp", 0, 50, 15, 1},
    {"smooth-clear-air", -30, 45, 15, 1},
};

TEST(SmoothTables, ValuesFarApartDifferForEveryKindOfSight) {
    for (const FarApart& row : far_apart) {
        const ColorTable table = find_color_table(row.table).value();
        for (const Sight& sight : sights) {
            double least = 1000;
            float least_at = 0, least_to = 0;
            for (float one = row.from; one <= row.to; one += row.step) {
                for (float other = one + row.apart; other <= row.to; other += row.step) {
                    // The circle of phases closes.
                    if (table.moment == level2::Moment::phi && other - one > 360 - row.apart) break;
                    const double differ = ciede2000(seen_by(sight, *color_of(table, one)),
                                                    seen_by(sight, *color_of(table, other)));
                    if (differ >= least) continue;
                    least = differ;
                    least_at = one;
                    least_to = other;
                }
            }
            EXPECT_GE(least, least_smooth_step)
                << row.table << " " << sight.name << " " << least_at << " " << least_to;
            ::testing::Test::RecordProperty(std::string(row.table) + " " + sight.name,
                                            std::to_string(least));
        }
    }
}

// A table without classes has no jump. Each stop begins with the color in which the previous stop
// ends.
TEST(SmoothTables, HaveNoClassesAndRiseInLightness) {
    for (const char* name :
         {"smooth-spectrum-width", "smooth-zdr", "smooth-rho", "smooth-cfp", "smooth-clear-air"}) {
        const ColorTable table = find_color_table(name).value();
        EXPECT_FALSE(is_stepped(table));
        EXPECT_TRUE(lightness_rises(table, 0, table.stops.size())) << name;
        for (std::size_t i = 1; i < table.stops.size(); ++i)
            EXPECT_EQ(table.stops[i].color, table.stops[i - 1].until) << name;
    }
}

TEST(SmoothTables, ReflectivityChangesItsHueAtTheBoundsOfClasses) {
    const ColorTable table = find_color_table("smooth-reflectivity").value();
    for (const float bound : {20.0F, 35.0F, 50.0F, 65.0F}) {
        const double across =
            color_difference(*color_of(table, bound - 0.5F), *color_of(table, bound + 0.5F));
        EXPECT_GT(across, 10) << bound;
    }
    for (float dbz = 6; dbz < 75; ++dbz) {
        const float beside = std::abs(std::remainder(dbz - 5, 15.0F));
        if (beside <= 1) continue;
        EXPECT_LT(color_difference(*color_of(table, dbz - 0.5F), *color_of(table, dbz + 0.5F)), 8)
            << dbz;
    }
}

}  // namespace
}  // namespace stormcellar::render
