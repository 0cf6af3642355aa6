#include "render/frame/probe.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/map/labels.h"
#include "render/products/section.h"
#include "stormcellar/grid/projection.h"
#include "tests/render/synthetic_storm.h"

namespace stormcellar::render {
namespace {

using grid::CellStatus;

// The grid has 100 x 100 columns. Column (30, 70) has 45 dBZ at 2.5 km; nothing was seen below 1
// km.
class ProbeTest : public ::testing::Test {
  protected:
    ProbeTest()
        : grid_(make_grid_of(small_spec(100, 10),
                             [](int ix, int iy, int iz) -> Cell {
                                 if (iz < 1 || ix >= 90) return {CellStatus::not_seen, 0};
                                 if (ix == 30 && iy == 70) return valued(iz == 4 ? 45 : 20);
                                 if (ix == 60) return {CellStatus::range_folded, 0};
                                 if (ix == 80) return {CellStatus::ambiguous, 0};
                                 return {CellStatus::no_echo, 0};
                             })),
          bricks_(bricks_of(grid_, 1, true)) {
        scene_.product = Product::composite;
        scene_.labels = false;
        scene_.width = scene_.height = 520;  // 5 pixels for each cell, and a margin of 2 %
    }

    Result<Probe> at(int ix, int iy) {
        return probe_pixel(bricks_.view(), facts_of(grid_), scene_, 10 + 5 * ix + 2,
                           520 - 11 - 5 * iy - 2, 2);
    }
    grid::GeoPoint place(double ix, double iy) {
        return grid::GridProjection(grid_.spec).to_geo({ix, iy});
    }

    grid::Grid grid_;
    grid::BrickGrid bricks_;
    Scene scene_;
};

TEST_F(ProbeTest, OfAMapTellsTheColumnThatIsDrawnThere) {
    const auto probe = at(30, 70);
    ASSERT_TRUE(probe) << probe.error().message;
    EXPECT_EQ(probe->status, CellStatus::value);
    EXPECT_EQ(probe->value, 45);
    EXPECT_EQ(probe->height_m, 2500);
    EXPECT_EQ(probe->lowest_seen_m, 1000);
    EXPECT_EQ(probe->highest_seen_m, 5000);
    EXPECT_NEAR(probe->place.latitude_deg, place(30, 70).latitude_deg, 0.003);
    EXPECT_NEAR(probe->place.longitude_deg, place(30, 70).longitude_deg, 0.003);
    EXPECT_EQ(probe_text(*probe, {}), "45 dBZ");
    EXPECT_EQ(probe_text(*at(20, 20), {}), "no echo");
    EXPECT_EQ(probe_text(*at(60, 20), {}), "range folded");
    EXPECT_EQ(probe_text(*at(80, 20), {}), "ambiguous");
    EXPECT_EQ(probe_text(*at(95, 20), {}), "not seen");
    EXPECT_FALSE(at(95, 20)->lowest_seen_m);
}

TEST_F(ProbeTest, OfEveryProductSaysWhatItShows) {
    scene_.product = Product::cappi;
    scene_.cappi_height_m = 2250;
    EXPECT_EQ(probe_text(*at(30, 70), {}), "32.5 dBZ");
    EXPECT_EQ(at(30, 70)->height_m, 2250);
    scene_.product = Product::echo_top;
    EXPECT_EQ(probe_text(*at(30, 70), {}), "at least 5 km");
    scene_.product = Product::lowest_seen;
    EXPECT_EQ(probe_text(*at(30, 70), {}), "1 km");
    scene_.product = Product::volume;
    scene_.camera = {180, 0, 1};
    EXPECT_EQ(probe_text(*at(30, 70), {}), "45 dBZ");
    EXPECT_EQ(at(30, 70)->height_m, 2500);
}

TEST_F(ProbeTest, AtAPlaceIsThatColumn) {
    const auto view = bricks_.view();
    const auto probe = probe_place(view, facts_of(grid_), scene_, place(30.4, 69.6), 1);
    ASSERT_TRUE(probe) << probe.error().message;
    EXPECT_EQ(probe->value, 45);
    const auto outside = probe_place(view, facts_of(grid_), scene_, place(99.6, 5), 1);
    ASSERT_FALSE(outside);
    EXPECT_THAT(outside.error().message, ::testing::HasSubstr("outside the grid"));
    EXPECT_EQ(probe_place(view, facts_of(grid_), scene_, {95, 0}, 1).error().code,
              ErrorCode::bad_argument);
}

// Labels move the picture, so the same column is at another pixel.
TEST_F(ProbeTest, CountsPixelsOfTheWholePicture) {
    scene_.labels = true;
    scene_.width = 796;
    scene_.height = 532;
    const auto at_pixel = [&](int x, int y) {
        return probe_pixel(bricks_.view(), facts_of(grid_), scene_, x, y, 1);
    };
    EXPECT_FALSE(at_pixel(300, 40)) << "the pixel is in the header";
    EXPECT_FALSE(at_pixel(790, 300)) << "the pixel is in the panel";
    // The map is square and in the middle of the picture, with a margin of 4 %.
    const auto layout =
        lay_out_labels(*Fonts::load(), scene_, facts_of(grid_), {legend_of(scene_), 50e3, {}});
    ASSERT_TRUE(layout);
    const double cell = layout->height / 104.0;
    const int x = static_cast<int>(layout->left + layout->width / 2.0 + (30.5 - 50) * cell);
    const int y = static_cast<int>(layout->top + layout->height / 2.0 - (70.5 - 50) * cell);
    const auto probe = at_pixel(x, y);
    ASSERT_TRUE(probe) << probe.error().message;
    EXPECT_EQ(probe->value, 45);
    EXPECT_NE(at_pixel(x + 5, y)->value, 45);
}

TEST_F(ProbeTest, OutsideIsBadArgument) {
    for (const auto& [x, y] : {std::pair{-1, 5}, std::pair{5, 520}, std::pair{2, 2}}) {
        const auto probe = probe_pixel(bricks_.view(), facts_of(grid_), scene_, x, y, 1);
        ASSERT_FALSE(probe) << x << "," << y;
        EXPECT_EQ(probe.error().code, ErrorCode::bad_argument);
    }
}

TEST_F(ProbeTest, OfASectionGivesDistanceAndHeight) {
    scene_.product = Product::section;
    scene_.section = SectionLine{place(10, 70), place(50, 70)};
    scene_.width = 400;  // 10 pixels a column
    scene_.height = 210;
    // The cells reach up to 5.25 km: 40 pixels a kilometer.
    const auto probe = probe_pixel(bricks_.view(), facts_of(grid_), scene_, 200, 210 - 1 - 100, 1);
    ASSERT_TRUE(probe) << probe.error().message;
    EXPECT_NEAR(*probe->distance_m, 20050, 30);
    EXPECT_NEAR(*probe->height_m, 2512.5, 1e-6);
    EXPECT_EQ(probe->status, CellStatus::value);
    EXPECT_NEAR(static_cast<double>(probe->value), 45 - 25 * 0.025, 0.01);
    EXPECT_EQ(probe->lowest_seen_m, 1000);
    EXPECT_EQ(probe_place(bricks_.view(), facts_of(grid_), scene_, place(30, 70), 1).error().code,
              ErrorCode::bad_argument);
}

}  // namespace
}  // namespace stormcellar::render
