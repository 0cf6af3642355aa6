#include "render/products/section.h"

#include <GeographicLib/Geodesic.hpp>
#include <gtest/gtest.h>

#include "render/color/built_in_tables.h"
#include "render/image/shades.h"
#include "stormcellar/grid/projection.h"
#include "tests/render/synthetic_storm.h"

namespace stormcellar::render {
namespace {

using grid::CellStatus;
using level2::Moment;

SectionLine between(const grid::GridSpec& spec, double x0, double y0, double x1, double y1) {
    const grid::GridProjection projection(spec);
    return {projection.to_geo({x0, y0}), projection.to_geo({x1, y1})};
}

// Trilinear interpolation must reproduce a plane exactly.
TEST(Section, OfAPlaneIsThatPlane) {
    const grid::GridSpec spec = small_spec(100, 20);
    const auto bricks = bricks_of(
        make_grid_of(spec, [](int ix, int iy,
                              int iz) { return valued(0.5 * ix + 0.25 * iy + 1.5 * iz - 20); }),
        2);
    const SectionLine line = between(spec, 20, 30, 80, 70);
    const Section section = cut_section(bricks.view(), Moment::ref, line, 60, 42, 2);
    const GeographicLib::Geodesic& earth = GeographicLib::Geodesic::WGS84();
    double length = 0;
    double azimuth = 0;
    double unused = 0;
    earth.Inverse(line.from.latitude_deg, line.from.longitude_deg, line.to.latitude_deg,
                  line.to.longitude_deg, length, azimuth, unused);
    EXPECT_NEAR(section.length_m, length, 1e-6);
    EXPECT_EQ(section.bottom_m, 0);
    EXPECT_EQ(section.top_m, 10250);
    const grid::GridProjection projection(spec);
    for (int x = 0; x < 60; ++x) {
        EXPECT_EQ(section.in_grid[static_cast<std::size_t>(x)], 1);
        grid::GeoPoint place;
        earth.Direct(line.from.latitude_deg, line.from.longitude_deg, azimuth,
                     length * (x + 0.5) / 60, place.latitude_deg, place.longitude_deg);
        const grid::ColumnPoint column = projection.to_column(place);
        for (int y = 0; y < 42; ++y) {
            const double height_m = 10250 * (y + 0.5) / 42;
            const std::size_t i = section.field.index(x, y);
            if (height_m < 250) {
                EXPECT_EQ(section.field.status[i], CellStatus::not_seen)
                    << "the place is below the cells";
                continue;
            }
            const double level = std::clamp(height_m / 500 - 1, 0.0, 19.0);
            ASSERT_EQ(section.field.status[i], CellStatus::value);
            // Codes of 0.01 dB are off by half a step.
            ASSERT_NEAR(static_cast<double>(section.field.values[i]),
                        0.5 * column.x + 0.25 * column.y + 1.5 * level - 20, 0.0051)
                << x << " " << y;
        }
    }
}

TEST(Section, ThroughCentresOfColumnsShowsTheCells) {
    const grid::GridSpec spec = small_spec(41, 8);
    const auto grid = make_grid_of(spec, [](int ix, int, int iz) -> Cell {
        if (ix < 10) return {CellStatus::not_seen, 0};
        if (ix < 20) return {CellStatus::no_echo, 0};
        if (ix < 30) return {CellStatus::range_folded, 0};
        if (ix >= 38) return {CellStatus::ambiguous, 0};
        return valued(iz * 5 + 10);
    });
    const auto bricks = bricks_of(grid, 1, true);
    // Each section runs from north to south along a column of the grid. This is nearly a straight
    // line on the map.
    for (const auto& [ix, status] :
         {std::pair{5, CellStatus::not_seen}, std::pair{15, CellStatus::no_echo},
          std::pair{25, CellStatus::range_folded}, std::pair{35, CellStatus::value},
          std::pair{39, CellStatus::ambiguous}}) {
        const Section section =
            cut_section(bricks.view(), Moment::ref, between(spec, ix, 35, ix, 5), 7, 9, 1);
        EXPECT_EQ(section.field.status[section.field.index(3, 4)], status) << ix;
    }
}

TEST(Section, BeyondTheGridIsNothing) {
    const grid::GridSpec spec = small_spec(20, 4);
    const auto bricks = bricks_of(make_grid_of(spec, [](int, int, int) { return valued(30); }));
    const Section section =
        cut_section(bricks.view(), Moment::ref, between(spec, -20.5, 10, 39.5, 10), 60, 4, 3);
    int inside = 0;
    for (const auto flag : section.in_grid)
        inside += flag;
    EXPECT_EQ(inside, 20) << "the middle third of 60 km";
    const Image image =
        draw_section(section, nws_reflectivity(), {0, 0, 60, 4}, 60, 4, {}, {}, nullptr);
    EXPECT_EQ(image.at(2, 1), shades::dark.page);
    EXPECT_EQ(image.at(30, 1), *color_of(nws_reflectivity(), 30));
}

TEST(Section, IsTheSameForAnyNumberOfThreads) {
    const grid::GridSpec spec = small_spec(90, 30, 4000, 500);
    const auto bricks = bricks_of(storm_grid(spec));
    const SectionLine line = between(spec, 3, 80, 85, 12);
    const Section one = cut_section(bricks.view(), Moment::ref, line, 333, 99, 1);
    const Section five = cut_section(bricks.view(), Moment::ref, line, 333, 99, 5);
    EXPECT_EQ(one.field.values, five.field.values);
    EXPECT_EQ(one.field.status, five.field.status);
}

TEST(Section, PlacesAreWrittenWithTheirHemisphere) {
    EXPECT_EQ(place_text({35.3333, -97.2778}), "35.333\u00B0N 97.278\u00B0W");
    EXPECT_EQ(place_text({-13.5, 144.9}), "13.500\u00B0S 144.900\u00B0E");
}

TEST(SectionPlace, LeavesRoomForAxesOnlyWithLabels) {
    const SectionPlace bare = section_place(100, 50, 1, false);
    EXPECT_EQ(bare.width, 100);
    EXPECT_EQ(bare.height, 50);
    const SectionPlace labelled = section_place(400, 300, 1, true);
    EXPECT_GT(labelled.left, 20);
    EXPECT_LT(labelled.left + labelled.width, 400);
    EXPECT_LT(labelled.top + labelled.height, 270);
}

TEST(Section, OutsideTheGridIsSaidToBe) {
    const grid::GridSpec spec = small_spec(41, 8);
    const auto bricks = bricks_of(make_grid_of(spec, [](int, int, int) { return valued(30); }));
    const auto check = [&](double x0, double x1) {
        return check_in_grid(
            cut_section(bricks.view(), Moment::ref, between(spec, x0, 20, x1, 20), 60, 9, 1), spec);
    };
    EXPECT_TRUE(check(-30, 10));
    EXPECT_TRUE(check(39, 90));
    const Status outside = check(42, 90);
    ASSERT_FALSE(outside);
    EXPECT_EQ(outside.error().code, ErrorCode::bad_argument);
    const grid::GeoPoint corner = grid::GridProjection(spec).to_geo({-0.5, -0.5});
    EXPECT_NE(outside.error().message.find(place_text(corner)), std::string::npos);
}

}  // namespace
}  // namespace stormcellar::render
