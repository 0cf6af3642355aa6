#include "stormcellar/render/units.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/color/built_in_tables.h"
#include "render/map/color_bar.h"
#include "render/map/legend.h"
#include "render/map/map_lines.h"
#include "render/view/length_text.h"
#include "stormcellar/grid/grid_spec.h"
#include "stormcellar/render/product.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::render {
namespace {

using ::testing::HasSubstr;

Units units(const char* names) {
    const auto read = units_from_names(names);
    EXPECT_TRUE(read) << names << ": " << (read ? "" : read.error().message);
    return read.value_or(Units{});
}

std::string refusal(const char* names) {
    const auto read = units_from_names(names);
    return read ? "" : read.error().message;
}

TEST(Units, NamesInAnyOrderAndCase) {
    const Units us = units("knots,miles,kft");
    EXPECT_EQ(us.speed, Unit::knots);
    EXPECT_EQ(us.distance, Unit::miles);
    EXPECT_EQ(us.height, Unit::kft);
    EXPECT_EQ(unit_names(us), "knots,miles,kft");
    EXPECT_EQ(unit_names(units("FT,mi,KT")), "knots,miles,feet");
    EXPECT_EQ(unit_names({}), "m/s,km");
    EXPECT_EQ(unit_names(units("mph")), "mph,km") << "km stays the default";
}

TEST(Units, KilometersApplyToTheQuantityWithoutAnotherUnit) {
    EXPECT_EQ(units("km,kft").distance, Unit::km);
    EXPECT_EQ(units("km,kft").height, Unit::kft);
    EXPECT_EQ(unit_names(units("km,nmi")), "m/s,nautical-miles,km");
    EXPECT_EQ(refusal("km,miles,kft"), "miles and km are both units of distances; give one of them")
        << "miles and kft leave no quantity for km";
}

TEST(Units, WrongNamesAreRefused) {
    EXPECT_EQ(refusal("knot"), "there is no unit 'knot'; did you mean 'knots'?");
    EXPECT_EQ(refusal("knots,mils"), "there is no unit 'mils'; did you mean 'miles'?");
    EXPECT_THAT(refusal("parsecs"), HasSubstr("km, kft or feet for heights"));
    EXPECT_THAT(refusal(""), HasSubstr("there is no unit ''"));
    EXPECT_THAT(refusal("knots,"), HasSubstr("there is no unit ''"));
    EXPECT_EQ(refusal("mph,knots"), "mph and knots are both units of speeds; give one of them");
}

// The factors follow from definitions: a nautical mile is 1852 m, a foot 0.3048 m, a mile 5280
// feet.
TEST(Units, ValuesAreConverted) {
    EXPECT_NEAR(shown_unit("m/s", units("knots")).per_stored, 3600.0 / 1852, 1e-12);
    EXPECT_NEAR(shown_unit("m/s", units("mph")).per_stored, 2.236936, 1e-6);
    EXPECT_NEAR(shown_unit("m/s", units("km/h")).per_stored, 3.6, 1e-12);
    EXPECT_NEAR(shown_unit("km", units("kft")).per_stored, 3.280840, 1e-6);
    EXPECT_EQ(shown_unit("km", units("miles")).symbol, "km") << "values in km are heights";
    EXPECT_EQ(shown_unit("dBZ", units("knots,miles,kft")).symbol, "dBZ");
    EXPECT_DOUBLE_EQ(shown_unit("dBZ", units("knots,miles,kft")).per_stored, 1);
}

TEST(LengthText, IsOfTheUnit) {
    EXPECT_EQ(distance_text(500, {}), "500 m");
    EXPECT_EQ(distance_text(50e3, {}), "50 km");
    EXPECT_EQ(height_text(3000, {}), "3 km");
    EXPECT_EQ(distance_text(30 * 1609.344, units("miles")), "30 mi");
    EXPECT_EQ(distance_text(804.672, units("miles")), "0.5 mi");
    EXPECT_EQ(height_text(3000, units("kft")), "9.84 kft")
        << "a height that is not round has three digits";
    EXPECT_EQ(height_text(3000, units("feet")), "9840 ft");
    EXPECT_EQ(height_text(12192, units("feet")), "40000 ft") << "no height has an exponent";
    EXPECT_EQ(number_text(1234567, 3), "1230000");
    EXPECT_EQ(number_text(-0.00123456, 3), "-0.00123");
    EXPECT_EQ(number_text(0), "0");
}

TEST(LengthText, RingsAreRoundInTheUnit) {
    const auto spacing = [](double asked_m, const char* names) {
        Scene scene;
        scene.range_ring_spacing_m = asked_m;
        scene.units = units(names);
        return drawn_ring_spacing(grid::default_spec(35, -97), scene);
    };
    EXPECT_DOUBLE_EQ(spacing(50e3, "km"), 50e3);
    EXPECT_DOUBLE_EQ(spacing(37e3, "km"), 37e3) << "kilometers are not rounded";
    EXPECT_DOUBLE_EQ(spacing(50e3, "miles"), 30 * 1609.344);
    EXPECT_DOUBLE_EQ(spacing(50e3, "nmi"), 25 * 1852.0);
    EXPECT_DOUBLE_EQ(spacing(160e3, "miles"), 100 * 1609.344);
    EXPECT_LE(std::hypot(230e3, 230e3) / spacing(1e3, "miles"), 20) << "there are at most 20 rings";
}

TEST(Units, LegendsAndTitlesHaveThem) {
    Scene scene;
    scene.units = units("knots,miles,kft");
    scene.moment = level2::Moment::vel;
    EXPECT_EQ(legend_of(scene).bar_heading, "kt");
    EXPECT_EQ(legend_of(scene).rows.front().text, "seen below 9.84 kft");
    scene.moment = level2::Moment::sw;
    EXPECT_EQ(legend_of(scene).bar_heading, "kt");
    scene.moment = level2::Moment::ref;
    EXPECT_EQ(legend_of(scene).bar_heading, "dBZ");
    scene.product = Product::echo_top;
    EXPECT_EQ(legend_of(scene).bar_heading, "kft");
    EXPECT_EQ(unit_shown(scene), "km") << "the stored values stay in km";
    scene.product = Product::cappi;
    EXPECT_EQ(product_title(scene), "Reflectivity at 9.843 kft above sea level (CAPPI)");
}

// The number beside each color is the value of the color.
TEST(Units, NumbersOfABarStandAtTheirValues) {
    const Rect box = {0, 0, 20, 400};
    const double per_value = shown_unit("m/s", units("knots")).per_stored;
    const ColorTable smooth = smooth_color_table(level2::Moment::vel);
    const ColorBar bar = color_bar({smooth, per_value}, box, 12, {});
    const double lowest = static_cast<double>(smooth.bar_begin.value_or(smooth.lowest()));
    const double span = static_cast<double>(smooth.end) - lowest;
    ASSERT_GT(bar.ticks.size(), 4U);
    for (const BarTick& tick : bar.ticks) {
        const double knots = std::stod(tick.text);
        EXPECT_DOUBLE_EQ(std::remainder(knots, 5.0), 0) << tick.text << " is not round";
        EXPECT_NEAR(tick.at, 400 - (knots * 1852 / 3600 - lowest) / span * 400, 1e-6);
    }
    // The classes of the Weather Service have bounds in whole knots, but are stored in m/s.
    std::vector<std::string> texts;
    for (const BarTick& tick :
         color_bar({default_color_table(level2::Moment::vel), per_value}, box, 12, {}).ticks)
        texts.push_back(tick.text);
    EXPECT_THAT(texts, ::testing::IsSupersetOf({"-64", "-50", "-36", "-26", "26", "36", "50"}));
}

}  // namespace
}  // namespace stormcellar::render
