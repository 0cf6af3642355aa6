#include "stormcellar/render/color_table.h"

#include <cmath>

#include <gtest/gtest.h>

namespace stormcellar::render {
namespace {

TEST(ColorTable, HasFifteenClassesOfFiveDecibelsFromFive) {
    for (std::size_t i = 0; i < nws_reflectivity().stops.size(); ++i) {
        EXPECT_EQ(nws_reflectivity().stops[i].from, 5 + 5 * static_cast<float>(i));
    }
}

TEST(ColorTable, GivesTheColorsOfTheWeatherService) {
    EXPECT_FALSE(color_of(nws_reflectivity(), 4.99F));
    EXPECT_FALSE(color_of(nws_reflectivity(), std::nanf("")));
    for (const auto& [dbz, color] : {std::pair{5.0F, Rgba8{0x04, 0xE9, 0xE7, 255}},
                                     {22.5F, {0x02, 0xFD, 0x02, 255}},
                                     {34.99F, {0x00, 0x8E, 0x00, 255}},
                                     {35.0F, {0xFD, 0xF8, 0x02, 255}},
                                     {51.0F, {0xFD, 0x00, 0x00, 255}},
                                     {67.0F, {0xF8, 0x00, 0xFD, 255}},
                                     {95.0F, {0xFD, 0xFD, 0xFD, 255}}})
        EXPECT_EQ(color_of(nws_reflectivity(), dbz), color) << dbz;
}

// Compares extinctions with docs/rendering.md, by hand: between two points the opacity is
// exponential in the value.
TEST(Extinction, OfReflectivityIsAVeilAndACore) {
    EXPECT_EQ(extinction_per_m(nws_reflectivity(), 4.99, 1), 0);
    EXPECT_EQ(extinction_per_m(nws_reflectivity(), std::nan(""), 1), 0);
    EXPECT_NEAR(extinction_per_m(nws_reflectivity(), 5, 1) * 1000, 0.0015, 1e-12);
    EXPECT_NEAR(extinction_per_m(nws_reflectivity(), 45, 1) * 1000, 0.25, 1e-12);
    EXPECT_NEAR(extinction_per_m(nws_reflectivity(), 47, 1) * 1000,
                0.25 * std::pow(1.1 / 0.25, 2.0 / 5), 1e-6);
    EXPECT_NEAR(extinction_per_m(nws_reflectivity(), 80, 1) * 1000, 6, 1e-12);
    EXPECT_NEAR(
        extinction_per_m(nws_reflectivity(), 40, 2.5) / extinction_per_m(nws_reflectivity(), 40, 1),
        2.5, 1e-12);
    double before = 0;
    for (double dbz = 5; dbz <= 80; dbz += 0.5) {
        const double here = extinction_per_m(nws_reflectivity(), dbz, 1);
        EXPECT_GE(here, before) << dbz;
        before = here;
    }
}

ColorTable smooth() {
    ColorTable table;
    table.stops = {{0, {0, 0, 0, 0}, {100, 200, 50, 255}},
                   {10, {255, 0, 0, 255}, {255, 0, 0, 255}}};
    table.end = 20;
    table.extinction = {{2, 0.5}, {4, 1.5}};
    return table;
}

TEST(ColorTable, ASmoothTableBlendsUpToTheNextStop) {
    EXPECT_FALSE(color_of(smooth(), -0.001F));
    EXPECT_EQ(color_of(smooth(), 0), (Rgba8{0, 0, 0, 0}));
    EXPECT_EQ(color_of(smooth(), 5), (Rgba8{50, 100, 25, 128}));
    EXPECT_EQ(color_of(smooth(), 10), (Rgba8{255, 0, 0, 255}));
    EXPECT_EQ(color_of(smooth(), 1e6F), (Rgba8{255, 0, 0, 255}));
}

TEST(ColorTable, ExtinctionIsStraightBetweenItsPoints) {
    EXPECT_EQ(extinction_per_m(smooth(), 1.9, 1), 0);
    EXPECT_DOUBLE_EQ(extinction_per_m(smooth(), 2, 1), 0.5e-3);
    EXPECT_DOUBLE_EQ(extinction_per_m(smooth(), 3.5, 2), 2.5e-3);
    EXPECT_DOUBLE_EQ(extinction_per_m(smooth(), 99, 1), 1.5e-3);
    ColorTable late = smooth();
    late.stops.front().from = 3;
    EXPECT_EQ(extinction_per_m(late, 2.5, 1), 0) << "a value without a color is clear";
}

}  // namespace
}  // namespace stormcellar::render
