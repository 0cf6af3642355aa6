#include "render/color/built_in_tables.h"

#include <set>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stormcellar/grid/brick_view.h"

namespace stormcellar::render {
namespace {

using level2::Moment;

TEST(BuiltInTables, AreValidOpaqueAndHaveNamesOfTheirOwn) {
    std::set<std::string> names;
    for (const ColorTable& table : built_in_tables()) {
        const Status valid = validate(table);
        EXPECT_TRUE(valid) << table.name << " " << valid.error().message;
        EXPECT_TRUE(names.insert(table.name).second) << table.name;
        const bool is_smooth = table.name.starts_with("smooth-");
        EXPECT_EQ(is_stepped(table), !is_smooth) << table.name;
        EXPECT_EQ(table.range_folded, (Rgba8{0x77, 0, 0x7D, 255}));
        // On maps, the smooth tables of reflectivity let the ground show through weak echo.
        if (is_smooth && table.moment == Moment::ref) continue;
        for (const ColorStop& stop : table.stops)
            EXPECT_EQ(stop.color[3], 255) << table.name;
    }
}

TEST(BuiltInTables, AreFoundByNameAndAllAreNamedOtherwise) {
    for (const ColorTable& table : built_in_tables()) {
        const auto found = find_color_table(table.name);
        ASSERT_TRUE(found);
        EXPECT_EQ(found->name, table.name);
    }
    const auto missing = find_color_table("rainbow");
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().code, ErrorCode::not_found);
    EXPECT_THAT(missing.error().message,
                ::testing::AllOf(::testing::HasSubstr("'rainbow'"),
                                 ::testing::HasSubstr("nws-velocity, nws-spectrum-width"),
                                 ::testing::HasSubstr("safe-reflectivity")));
}

TEST(BuiltInTables, EachMomentHasOneOfItsOwnUnit) {
    for (const Moment moment : level2::all_moments) {
        const ColorTable& table = default_color_table(moment);
        EXPECT_EQ(table.moment, table_moment(moment));
        EXPECT_EQ(table.unit, unit_of(moment)) << table.name;
    }
    EXPECT_EQ(unit_of(Moment::vel), "m/s");
    EXPECT_EQ(unit_of(Moment::rho), "");
    for (const auto& [moment, shared] :
         {std::pair{Moment::ref, Moment::ref}, std::pair{Moment::veld, Moment::vel},
          std::pair{Moment::srv, Moment::vel}, std::pair{Moment::divg, Moment::azsh}})
        EXPECT_EQ(table_moment(moment), shared);
}

TEST(BuiltInTables, HaveTheWeatherServicesColors) {
    const ColorTable& velocity = default_color_table(Moment::vel);
    EXPECT_EQ(color_of(velocity, -64), (Rgba8{0x02, 0xFC, 0x02, 255}));
    EXPECT_EQ(color_of(velocity, -5.1F), (Rgba8{0x04, 0x72, 0x02, 255}));
    EXPECT_EQ(color_of(velocity, 0), (Rgba8{0x80, 0x80, 0x80, 255})) << "air at rest is gray";
    EXPECT_EQ(color_of(velocity, 60), (Rgba8{0xFE, 0, 0, 255}));
    EXPECT_EQ(color_of(default_color_table(Moment::sw), 4), (Rgba8{0, 0xBB, 0, 255}));
    EXPECT_EQ(color_of(default_color_table(Moment::rho), 0.965F), (Rgba8{0xFF, 0x2B, 0, 255}));
    EXPECT_FALSE(color_of(default_color_table(Moment::rho), 0.1F));
    EXPECT_EQ(color_of(default_color_table(Moment::zdr), 2.2F), (Rgba8{0xFF, 0xFF, 0x60, 255}));
    EXPECT_EQ(color_of(echo_top_colors(), 12.5F), (Rgba8{0, 0xEF, 0, 255}));
    EXPECT_EQ(color_of(vil_colors(), 52), (Rgba8{0xDA, 0, 0, 255}));
    EXPECT_EQ(color_of(height_colors(), -1), height_colors().stops.front().color);
}

TEST(BuiltInTables, EachMomentButClassesHasASmoothOne) {
    for (const Moment moment : level2::all_moments) {
        const ColorTable& table = smooth_color_table(moment);
        EXPECT_EQ(table.unit, unit_of(moment)) << table.name;
        if (level2::facts_of(moment).is_categorical) {
            EXPECT_TRUE(is_stepped(table)) << table.name;
            continue;
        }
        EXPECT_TRUE(table.name.starts_with("smooth-")) << table.name;
        EXPECT_FALSE(is_stepped(table)) << table.name;
    }
    EXPECT_EQ(clear_air_colors().name, "smooth-clear-air");
}

// Extinction is symmetric about 0, so that both sides of a couplet are equally dense.
TEST(DefaultExtinction, OfVelocityGoesBySpeed) {
    const ColorTable& table = default_color_table(Moment::vel);
    double before = 0;
    for (double speed = 0; speed <= 60; speed += 2.5) {
        const double away = extinction_per_m(table, speed, 1);
        EXPECT_DOUBLE_EQ(away, extinction_per_m(table, -speed, 1)) << speed;
        EXPECT_GE(away, before);
        before = away;
    }
    EXPECT_DOUBLE_EQ(extinction_per_m(table, 20, 1) * 1000, (0.03 + 0.2) / 2);
    EXPECT_DOUBLE_EQ(extinction_per_m(table, -63, 1) * 1000, 0.5);
}

// Every value that the cache can hold has extinction exactly if it has a color, so that a volume
// leaves out no colored echo.
TEST(DefaultExtinction, WhatHasAColorCanBeSeen) {
    for (const Moment moment : level2::all_moments) {
        const ColorTable& table = default_color_table(moment);
        const grid::Quantization codes = grid::default_quantization(moment);
        for (std::uint32_t code = grid::first_value_code; code <= codes.largest_code(); ++code) {
            const float value = codes.value_of(static_cast<std::uint16_t>(code));
            const bool visible = extinction_per_m(table, static_cast<double>(value), 1) > 0;
            ASSERT_EQ(visible, color_of(table, value).has_value()) << table.name << " " << value;
        }
    }
}

TEST(DefaultExtinction, OfReflectivityBeginsWhereATableDoes) {
    EXPECT_EQ(default_extinction(Moment::ref, -7.5F).front().value, -8);
    EXPECT_EQ(default_extinction(Moment::ref, -1000).front().value, -32);
    EXPECT_EQ(default_extinction(Moment::ref, 1000).front().value, 79);
}

TEST(Validate, NamesWhatIsWrongWithATable) {
    const auto with = [](auto change) {
        ColorTable table = nws_reflectivity();
        change(table);
        const Status status = validate(table);
        return status ? std::string{} : status.error().message;
    };
    using ::testing::HasSubstr;
    EXPECT_EQ(with([](ColorTable&) {}), "");
    EXPECT_THAT(with([](ColorTable& t) { t.stops.clear(); }), HasSubstr("no colors"));
    EXPECT_THAT(with([](ColorTable& t) { t.stops[3].from = t.stops[2].from; }),
                HasSubstr("do not rise"));
    EXPECT_THAT(with([](ColorTable& t) { t.stops[3].from = std::nanf(""); }),
                HasSubstr("do not rise"));
    EXPECT_THAT(with([](ColorTable& t) { t.end = 75; }), HasSubstr("ends before"));
    EXPECT_THAT(with([](ColorTable& t) { t.bar_begin = 90.0F; }), HasSubstr("begins"));
    EXPECT_THAT(with([](ColorTable& t) { t.extinction.clear(); }), HasSubstr("no opacity"));
    EXPECT_THAT(with([](ColorTable& t) { t.extinction[1].value = -9; }), HasSubstr("opacities"));
    EXPECT_THAT(with([](ColorTable& t) { t.extinction[1].per_km = -1; }), HasSubstr("per km"));
    EXPECT_THAT(with([](ColorTable& t) { t.extinction[1].per_km = std::nan(""); }),
                HasSubstr("per km"));
}

}  // namespace
}  // namespace stormcellar::render
