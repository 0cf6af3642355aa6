#include "render/map/color_bar.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/color/built_in_tables.h"
#include "render/image/shades.h"

namespace stormcellar::render {
namespace {

const Rect box = {10, 100, 20, 400};

ColorTable table_of(std::vector<ColorStop> stops, float end) {
    ColorTable table = nws_reflectivity();
    table.stops = std::move(stops);
    table.end = end;
    return table;
}

// Expects that the blocks fill the box from bottom to top, without gap or overlap.
void expect_filled(const ColorBar& bar, const Rect& whole) {
    double bottom = whole.bottom();
    for (const BarBlock& block : bar.blocks) {
        EXPECT_EQ(block.box.bottom(), bottom);
        EXPECT_EQ(block.box.y, std::round(block.box.y));
        EXPECT_EQ(block.box.width, whole.width);
        bottom = block.box.y;
    }
    EXPECT_EQ(bottom, whole.y);
}

TEST(ColorBar, ClassesHaveOneHeightAndTheirLowerBounds) {
    const ColorBar bar = color_bar({nws_reflectivity()}, box, 11.5, shades::dark.land.seen);
    ASSERT_EQ(bar.blocks.size(), 15U);
    expect_filled(bar, box);
    ASSERT_EQ(bar.ticks.size(), 15U);
    for (std::size_t i = 0; i < 15; ++i) {
        EXPECT_EQ(bar.blocks[i].color, nws_reflectivity().stops[i].color);
        EXPECT_NEAR(bar.blocks[i].box.height, 400 / 15.0, 1);
        EXPECT_EQ(bar.ticks[i].text, std::to_string(5 + 5 * i));
        EXPECT_EQ(bar.ticks[i].at, bar.blocks[i].box.bottom());
    }
}

TEST(ColorBar, UnevenClassesKeepTheirPlace) {
    const Rgba8 a = {1, 0, 0, 255};
    const Rgba8 b = {2, 0, 0, 255};
    const ColorBar bar =
        color_bar({table_of({{-50, a, a}, {-1, b, b}, {0.5, a, a}, {100, b, b}}, 200)}, box, 11.5,
                  shades::dark.land.seen);
    ASSERT_EQ(bar.blocks.size(), 4U);
    expect_filled(bar, box);
    std::vector<std::string> texts;
    for (const BarTick& tick : bar.ticks)
        texts.push_back(tick.text);
    EXPECT_THAT(texts, ::testing::ElementsAre("-50", "-1", "0.5", "100"));
}

TEST(ColorBar, TicksKeepTheirDistanceInALowBar) {
    for (const double height : {400.0, 150.0, 61.0, 30.0, 15.0}) {
        const Rect low = {0, 50, 20, height};
        const ColorBar bar = color_bar({nws_reflectivity()}, low, 11.5, shades::dark.land.seen);
        expect_filled(bar, low);
        for (std::size_t i = 1; i < bar.ticks.size(); ++i)
            EXPECT_GE(bar.ticks[i - 1].at - bar.ticks[i].at, 10.5) << height;
        EXPECT_FALSE(bar.ticks.empty());
    }
}

TEST(ColorBar, ABlendIsRegularInValue) {
    const ColorTable table = table_of({{-30, {0, 0, 255, 255}, {255, 255, 255, 255}},
                                       {10, {255, 255, 255, 255}, {255, 0, 0, 255}}},
                                      30);
    const ColorBar bar = color_bar({table}, box, 20, shades::dark.land.seen);
    expect_filled(bar, box);
    EXPECT_GT(bar.blocks.size(), 100U);
    for (const BarBlock& block : bar.blocks) {
        const double middle = block.box.y + block.box.height / 2;
        const double value = -30 + 60 * (box.bottom() - middle) / box.height;
        const Rgba8 expected = *color_of(table, static_cast<float>(value));
        for (std::size_t c = 0; c < 3; ++c)
            EXPECT_NEAR(block.color[c], expected[c], 3) << value;
    }
    std::vector<std::string> texts;
    for (const BarTick& tick : bar.ticks) {
        texts.push_back(tick.text);
        EXPECT_NEAR(tick.at, box.bottom() - (std::stod(tick.text) + 30) / 60 * box.height, 1e-6);
    }
    EXPECT_THAT(texts, ::testing::ElementsAre("-30", "-25", "-20", "-15", "-10", "-5", "0", "5",
                                              "10", "15", "20", "25", "30"));
}

TEST(ColorBar, AClassThatReachesDownFarHasNoNumber) {
    const ColorBar bar =
        color_bar({default_color_table(level2::Moment::vel)}, box, 11.5, shades::dark.land.seen);
    EXPECT_EQ(bar.blocks.size(), 15U);
    EXPECT_EQ(bar.ticks.front().text, "-33");
}

TEST(ColorBar, ClearColorsShowTheGround) {
    const ColorBar bar = color_bar(
        {table_of({{0, {9, 9, 9, 0}, {9, 9, 9, 0}}, {10, {1, 2, 3, 255}, {1, 2, 3, 255}}}, 20)},
        box, 11.5, shades::dark.land.seen);
    EXPECT_EQ(bar.blocks.front().color, shades::dark.land.seen);
}

}  // namespace
}  // namespace stormcellar::render
