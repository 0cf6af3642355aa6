#include "render/colour/colour_bar.h"

#include <gtest/gtest.h>

#include "render/colour/built_in_tables.h"
#include "render/colour/colour_file.h"
#include "render/shades.h"

namespace stormcellar::render {
namespace {

TEST(ColourBar, ShowsEachClassWithItsLowerBound) {
    const ColourBar bar = colour_bar(nws_reflectivity(), 15);
    ASSERT_EQ(bar.blocks.size(), 15U);
    EXPECT_EQ(bar.blocks.front().low, 0);
    EXPECT_EQ(bar.blocks.back().high, 1);
    for (std::size_t i = 1; i < 15; ++i)
        EXPECT_EQ(bar.blocks[i].low, bar.blocks[i - 1].high);
    ASSERT_EQ(bar.ticks.size(), 15U);
    EXPECT_EQ(bar.ticks[0].text, "5");
    EXPECT_EQ(bar.ticks[14].text, "75");
    EXPECT_EQ(bar.ticks[14].at, 14.0 / 15);
}

TEST(ColourBar, LeavesOutTicksThatHaveNoRoom) {
    const ColourBar bar = colour_bar(nws_reflectivity(), 8);
    EXPECT_EQ(bar.ticks.size(), 8U);
    EXPECT_EQ(bar.ticks[1].text, "15");
}

TEST(ColourBar, AClassThatReachesDownFarHasNoNumber) {
    const ColourBar bar = colour_bar(default_colour_table(level2::Moment::vel), 20);
    EXPECT_EQ(bar.blocks.size(), 15U);
    EXPECT_EQ(bar.ticks.front().text, "-33");
}

TEST(ColourBar, OfABlendIsInProportionWithRoundValues) {
    const auto table =
        parse_pal("Color: -12 0 0 0\nColor: 30 200 100 50\nColor4: 48 9 9 9 0\n", "p");
    ASSERT_TRUE(table);
    const ColourBar bar = colour_bar(*table, 9);
    EXPECT_EQ(table->end, 66);
    ASSERT_EQ(bar.ticks.size(), 8U);
    EXPECT_EQ(bar.ticks[0].text, "-10");
    EXPECT_EQ(bar.ticks[1].text, "0");
    EXPECT_NEAR(bar.ticks[1].at, 12.0 / 78, 1e-12);
    EXPECT_EQ(bar.ticks.back().text, "60");
    EXPECT_EQ(bar.blocks.back().colour, shades::seen) << "clear colours show the ground";
}

TEST(RoundStep, IsOneTwoOrFiveTimesAPowerOfTen) {
    EXPECT_DOUBLE_EQ(round_step(10, 10), 1);
    EXPECT_DOUBLE_EQ(round_step(11, 10), 2);
    EXPECT_DOUBLE_EQ(round_step(0.9, 4), 0.5);
    EXPECT_DOUBLE_EQ(round_step(6000, 10), 1000);
    EXPECT_DOUBLE_EQ(round_step(51, 10), 10);
}

TEST(Over, MixesByAlpha) {
    EXPECT_EQ(over({200, 100, 0, 255}, {0, 0, 100, 255}), (Rgba8{200, 100, 0, 255}));
    EXPECT_EQ(over({200, 100, 0, 0}, {0, 0, 100, 255}), (Rgba8{0, 0, 100, 255}));
    EXPECT_EQ(over({255, 100, 0, 51}, {0, 0, 100, 255}), (Rgba8{51, 20, 80, 255}));
}

}  // namespace
}  // namespace stormcellar::render
