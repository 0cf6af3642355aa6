#include "stormcellar/render/view_geometry.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/render/synthetic_storm.h"

namespace stormcellar::render {
namespace {

ViewGeometry view_from(double azimuth_deg, double tilt_deg, double zoom = 1) {
    return {small_spec(100, 16), Camera{azimuth_deg, tilt_deg, zoom}, 8, 800, 600};
}

// Tests the orientation by a table of the directions of east, north and up in the picture.
TEST(ViewGeometry, EastNorthAndUpGoWhereAForecasterExpects) {
    struct Case {
        double azimuth_deg, tilt_deg;
        int east_x, east_y, north_x, north_y, up_y;  // signs in the picture, y downward
    };
    const Case cases[] = {
        {180, 0, 1, 0, 0, -1, 0},    // a map
        {180, 55, 1, 0, 0, -1, -1},  // from the south: north is further up
        {180, 90, 1, 0, 0, 0, -1},   // along the ground
        {0, 55, -1, 0, 0, 1, -1},    // from the north: east is left, north comes nearer
        {90, 55, 0, 1, 1, 0, -1},    // from the east: north is right, east comes nearer
        {270, 55, 0, -1, -1, 0, -1}, {540, 55, 1, 0, 0, -1, -1}, {-180, 55, 1, 0, 0, -1, -1},
    };
    const auto sign = [](double v) { return std::abs(v) < 1e-9 ? 0 : (v > 0 ? 1 : -1); };
    for (const Case& c : cases) {
        const ViewGeometry view = view_from(c.azimuth_deg, c.tilt_deg);
        const Pixel origin = view.project(0, 0, 0);
        const Pixel east = view.project(1000, 0, 0);
        const Pixel north = view.project(0, 1000, 0);
        const Pixel up = view.project(0, 0, 1000);
        SCOPED_TRACE(::testing::Message() << c.azimuth_deg << " " << c.tilt_deg);
        EXPECT_EQ(sign(east.x - origin.x), c.east_x);
        EXPECT_EQ(sign(east.y - origin.y), c.east_y);
        EXPECT_EQ(sign(north.x - origin.x), c.north_x);
        EXPECT_EQ(sign(north.y - origin.y), c.north_y);
        EXPECT_EQ(sign(up.x - origin.x), 0);
        EXPECT_EQ(sign(up.y - origin.y), c.up_y);
    }
}

TEST(ViewGeometry, TheBoxJustFitsAtZoomOneFromEverywhere) {
    for (int azimuth = 0; azimuth < 360; azimuth += 17) {
        for (int tilt = 0; tilt <= 90; tilt += 15) {
            const ViewGeometry view = view_from(azimuth, tilt);
            double reach_x = 0;
            double reach_y = 0;
            for (int corner = 0; corner < 8; ++corner) {
                const Pixel p =
                    view.project((corner & 1) != 0 ? 50e3 : -50e3, (corner & 2) != 0 ? 50e3 : -50e3,
                                 (corner & 4) != 0 ? view.top_m() : 0);
                reach_x = std::max(reach_x, std::abs(p.x - 400) / 400);
                reach_y = std::max(reach_y, std::abs(p.y - 300) / 300);
            }
            EXPECT_LT(std::max(reach_x, reach_y), 1);
            EXPECT_GT(std::max(reach_x, reach_y), 0.95);
        }
    }
}

TEST(ViewGeometry, PointAndProjectUndoEachOther) {
    const ViewGeometry view = view_from(217, 38, 1.7);
    for (const double depth : {-30e3, 0.0, 55e3}) {
        const Pixel pixel{123.4, 456.7};
        const Vec3 p = view.point(pixel, depth);
        const Pixel back = view.project(p[0], p[1], p[2] / view.exaggeration());
        EXPECT_NEAR(back.x, pixel.x, 1e-9);
        EXPECT_NEAR(back.y, pixel.y, 1e-9);
    }
}

TEST(ViewGeometry, TheGroundUnderAPixelProjectsBackToIt) {
    const ViewGeometry view = view_from(30, 70);
    const auto ground = view.ground({200.5, 333.5});
    ASSERT_TRUE(ground);
    const Pixel back = view.project(ground->x_m, ground->y_m, 0);
    EXPECT_NEAR(back.x, 200.5, 1e-9);
    EXPECT_NEAR(back.y, 333.5, 1e-9);
    EXPECT_FALSE(view_from(30, 90).ground({200.5, 333.5}));
}

// ground_of_row() must give the numbers of ground(), to the bit.
TEST(ViewGeometry, TheGroundOfARowIsThatOfItsPixels) {
    const Camera from_above{180, 0, 1}, aslant{211, 63, 1.7}, level{180, 90, 1};
    Camera perspective{140, 71, 1};
    perspective.field_of_view_deg = 50;
    Camera placed = perspective;
    placed.eye = Eye{-70e3, 30e3, 4000};
    placed.look_at = Eye{10e3, -5e3, 2000};
    std::size_t sky = 0, ground = 0;
    for (const Camera& camera : {from_above, aslant, level, perspective, placed}) {
        for (const bool curved : {false, true}) {
            const ViewGeometry view(small_spec(100, 16), camera, 8, 101, 67, curved);
            GroundRow row;
            for (int y = 0; y < view.height(); ++y) {
                view.ground_of_row(y, row);
                for (int x = 0; x < view.width(); ++x) {
                    const auto at = view.ground({x + 0.5, y + 0.5});
                    const auto place = static_cast<std::size_t>(x);
                    ASSERT_EQ(row.is_sky(place), !at) << x << " " << y << " " << curved;
                    (at ? ground : sky) += 1;
                    if (!at) continue;
                    ASSERT_EQ(row.x_m[place], at->x_m) << x << " " << y << " " << curved;
                    ASSERT_EQ(row.y_m[place], at->y_m) << x << " " << y << " " << curved;
                }
            }
        }
    }
    EXPECT_GT(sky, 10'000U);
    EXPECT_GT(ground, 30'000U);
}

TEST(ViewGeometry, DepthsEncloseTheCells) {
    for (int azimuth = 0; azimuth < 360; azimuth += 40) {
        const ViewGeometry view = view_from(azimuth, 62);
        double nearest = 1e300;
        double farthest = -1e300;
        for (int corner = 0; corner < 8; ++corner) {
            const double x = (corner & 1) != 0 ? view.half_x_m() : -view.half_x_m();
            const double y = (corner & 2) != 0 ? view.half_y_m() : -view.half_y_m();
            const double h = (corner & 4) != 0 ? view.top_m() : view.bottom_m();
            const Vec3 middle = view.point({400, 300}, 0);
            const double depth = (x - middle[0]) * view.forward()[0] +
                                 (y - middle[1]) * view.forward()[1] +
                                 (h * 8 - middle[2]) * view.forward()[2];
            nearest = std::min(nearest, depth);
            farthest = std::max(farthest, depth);
        }
        EXPECT_NEAR(view.near_m(), nearest, 1e-6);
        EXPECT_NEAR(view.far_m(), farthest, 1e-6);
    }
}

TEST(HeightRange, EndsHalfALevelBeyondTheLevels) {
    grid::GridSpec spec = small_spec(4, 2);
    spec.levels_m = {500, 1000, 3000};
    EXPECT_EQ(height_range(spec).bottom_m, 250);
    EXPECT_EQ(height_range(spec).top_m, 4000);
    spec.levels_m = {2000};
    EXPECT_EQ(height_range(spec).bottom_m, 1500);
    EXPECT_EQ(height_range(spec).top_m, 2500);
}

}  // namespace
}  // namespace stormcellar::render
