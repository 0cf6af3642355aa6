// Tests hodographs, and pictures of wind over time and height. The tests read pixels at known
// places.
#include <cmath>

#include <gtest/gtest.h>

#include "render/wind/hodograph.h"
#include "render/wind/time_height.h"
#include "render/wind/wind_barb.h"

namespace stormcellar::render {
namespace {

using retrieve::Birds;
using retrieve::LayerWind;
using retrieve::Motion;
using retrieve::StormMotions;
using retrieve::WindLayer;

const Result<StormMotions> no_motions = fail(ErrorCode::not_found, "no layer has a wind");

// Makes layers of 200 m with a wind that rises to the east by 3 m/s a kilometer.
WindColumn column_up_to(double top_m, std::chrono::minutes time = {}) {
    WindColumn column{UtcTime{} + time, {}};
    for (double bottom = 0; bottom < top_m; bottom += 200) {
        WindLayer layer{bottom, bottom + 200};
        layer.wind = LayerWind{.motion = {layer.middle_m() * 0.003, 8}};
        column.layers.push_back(layer);
    }
    return column;
}

class WindPictures : public ::testing::Test {
  protected:
    WindPictures() {
        page_.station = "KTLX";
        page_.antenna_altitude_m = 400;
        page_.method = "VVP";
    }
    static Rgba8 pixel(const Image& image, Point at) {
        return image.at(static_cast<int>(at.x), static_cast<int>(at.y));
    }
    [[nodiscard]] Rgba8 color_at(double height_m) const {
        return hodograph_color(height_m, page_.units, page_.theme);
    }

    WindPage page_;
    Fonts fonts_ = Fonts::load().value();
};

TEST_F(WindPictures, TheLineHasTheColorOfItsHeight) {
    for (const Theme theme : {Theme::dark, Theme::light}) {
        page_.theme = theme;
        const WindColumn column = column_up_to(11'000);
        const Image image = draw_hodograph(page_, column, no_motions, fonts_);
        const HodographPlan plan = plan_hodograph(page_, column, no_motions);
        for (const double height : {500.0, 2'000.0, 4'500.0, 7'500.0, 10'400.0})
            EXPECT_EQ(pixel(image, plan.at({height * 0.003, 8})), color_at(height)) << height;
    }
}

TEST_F(WindPictures, AllWindsAndMotionsAreOnTheHodograph) {
    for (const Motion& wind : {Motion{60, -20}, {-3, 1}, {0, 0}, {-80, -80}}) {
        WindColumn column = column_up_to(3'000);
        column.layers.back().wind->motion = wind;
        const Result<StormMotions> motions =
            StormMotions{.right = {20, -30}, .left = {wind.v_mps, wind.u_mps}, .mean = {}};
        const HodographPlan plan = plan_hodograph(page_, column, motions);
        for (const Motion& shown : {wind, motions->right, motions->left, Motion{}}) {
            const Point at = plan.at(shown);
            EXPECT_GT(at.x, plan.plot.x + 10);
            EXPECT_LT(at.x, plan.plot.right() - 10);
            EXPECT_GT(at.y, plan.plot.y + 10);
            EXPECT_LT(at.y, plan.plot.bottom() - 10);
        }
        EXPECT_NEAR(std::remainder(plan.ring_step_mps, 1), 0, 1e-9);
    }
}

TEST_F(WindPictures, AWideGapStaysOpen) {
    WindColumn column = column_up_to(9'000);
    for (std::size_t i = 15; i < 30; ++i)
        column.layers[i].wind = tl::unexpected(retrieve::NoWind::clutter);
    const Image image = draw_hodograph(page_, column, no_motions, fonts_);
    const HodographPlan plan = plan_hodograph(page_, column, no_motions);
    EXPECT_EQ(pixel(image, plan.at({4'400 * 0.003, 8})), shades_of(page_.theme).page);
    EXPECT_EQ(pixel(image, plan.at({7'500 * 0.003, 8})), color_at(7'500));
}

TEST_F(WindPictures, HodographColorsChangeAtTheMarksOfTheUnit) {
    EXPECT_NE(color_at(999), color_at(1'001));
    EXPECT_EQ(color_at(3'020), color_at(3'060));
    page_.units.height = Unit::kft;
    EXPECT_EQ(color_at(999), color_at(1'001));
    EXPECT_NE(color_at(3'040), color_at(3'060)) << "10 kft are 3048 m";
}

TEST_F(WindPictures, OddPagesAreDrawn) {
    WindColumn calm = column_up_to(400);
    for (WindLayer& layer : calm.layers)
        layer.wind->motion = {};
    for (const WindColumn& column : {WindColumn{}, calm, column_up_to(12'000)}) {
        for (const auto& [width, height] : {std::pair{16, 16}, {360, 360}, {1600, 300}}) {
            page_.width = width;
            page_.height = height;
            EXPECT_EQ(draw_hodograph(page_, column, no_motions, fonts_).width, width);
            EXPECT_EQ(draw_time_height(page_, {{column}}, fonts_).height, height);
        }
    }
}

TEST_F(WindPictures, ManyVolumesAreThinnedOutEvenly) {
    std::vector<WindColumn> columns;
    for (int minute = 0; minute < 24 * 60; minute += 5)
        columns.push_back(column_up_to(12'000, std::chrono::minutes(minute)));
    const TimeHeightPlan plan = plan_time_height(page_, columns);
    EXPECT_GT(plan.columns.size(), 20U);
    for (std::size_t i = 1; i < plan.columns.size(); ++i) {
        const double apart =
            plan.x_of(columns[plan.columns[i]].time) - plan.x_of(columns[plan.columns[i - 1]].time);
        EXPECT_GE(apart, 26);
        EXPECT_LE(apart, 45);
    }
    EXPECT_GE(plan.y_of(400) - plan.y_of(400 + 200 * static_cast<double>(plan.layer_step)), 15);
    EXPECT_NEAR(plan.y_of(400), plan.plot.bottom(), 1e-9) << "the antenna is at the bottom";
}

TEST_F(WindPictures, BarbsHaveTheColorOfTheirSpeedAndBirdsAreGray) {
    WindColumn column = column_up_to(3'000);
    for (WindLayer& layer : column.layers)
        layer.wind->motion = {-25, 0};  // the staff points to the east
    column.layers[6].wind->birds = Birds::likely;
    const Image image = draw_time_height(page_, {{column}}, fonts_);
    const TimeHeightPlan plan = plan_time_height(page_, {{column}});
    ASSERT_EQ(plan.layer_step, 1U);
    const auto staff = [&](double height_m) {
        return pixel(image, {plan.x_of(column.time) + 0.3 * plan.barb_px,
                             std::floor(plan.y_of(400 + height_m))});
    };
    const Rgba8 color = wind_speed_color(25, page_.units, page_.theme);
    const Rgba8 gray = shades_of(page_.theme).border;
    const auto distance = [](Rgba8 one, Rgba8 other) {
        int sum = 0;
        for (std::size_t i = 0; i < 3; ++i)
            sum += std::abs(one[i] - other[i]);
        return sum;
    };
    EXPECT_LT(distance(staff(900), color), distance(staff(900), gray));
    EXPECT_LT(distance(staff(900), color), distance(staff(900), shades_of(page_.theme).page));
    EXPECT_LT(distance(staff(1'300), gray), distance(staff(1'300), color));
}

TEST(WindBarb, CountsFlagsAndBarbs) {
    const auto parts = [](double knots) {
        const BarbParts found = barb_parts(knots);
        return std::array{found.flags, found.long_barbs, found.short_barbs};
    };
    using Parts = std::array<int, 3>;
    EXPECT_EQ(parts(0), (Parts{0, 0, 0}));
    EXPECT_EQ(parts(2.4), (Parts{0, 0, 0}));
    EXPECT_EQ(parts(2.6), (Parts{0, 0, 1}));
    EXPECT_EQ(parts(12), (Parts{0, 1, 0}));
    EXPECT_EQ(parts(48), (Parts{1, 0, 0}));
    EXPECT_EQ(parts(117), (Parts{2, 1, 1}));
}

// A wind from the west has its staff to the west and its barbs to the north.
TEST(WindBarb, PointsToWhereTheWindComesFrom) {
    constexpr Rgba8 black = {0, 0, 0, 255}, white = {255, 255, 255, 255};
    Canvas canvas(100, 100, white);
    draw_wind_barb(canvas, {50, 50}, {50, 0}, 40, 3, black);
    const Image image = canvas.image();
    EXPECT_EQ(image.at(30, 50), black);
    EXPECT_EQ(image.at(70, 50), white);
    int north = 0, south = 0;
    for (int x = 0; x < 100; ++x) {
        north += image.at(x, 44) == white ? 0 : 1;
        south += image.at(x, 56) == white ? 0 : 1;
    }
    EXPECT_GT(north, 5);
    EXPECT_EQ(south, 0);
}

}  // namespace
}  // namespace stormcellar::render
