// Tests cameras with a position, and a curved earth: geometry and slicer.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "render/volume/slicer.h"
#include "stormcellar/render/view_geometry.h"
#include "tests/render/against_reference.h"
#include "tests/render/synthetic_storm.h"

namespace stormcellar::render {
namespace {

Camera perspective(double azimuth_deg, double tilt_deg, double field_of_view_deg, double zoom = 1) {
    Camera camera;
    camera.azimuth_deg = azimuth_deg;
    camera.tilt_deg = tilt_deg;
    camera.zoom = zoom;
    camera.field_of_view_deg = field_of_view_deg;
    return camera;
}

Camera standing_at(const Eye& eye, double azimuth_deg, double tilt_deg, double field_of_view_deg) {
    Camera camera = perspective(azimuth_deg, tilt_deg, field_of_view_deg);
    camera.eye = eye;
    return camera;
}

// Returns all kinds of views of one grid: from outside, inside and below.
std::vector<Camera> cameras() {
    return {Camera{200, 50, 1},
            perspective(180, 55, 40),
            perspective(37, 90, 60, 2),
            perspective(310, 0, 90),
            standing_at({10e3, -20e3, 3e3}, 150, 80, 70),
            standing_at({-30e3, 5e3, 200}, 270, 120, 90),
            standing_at({0, 0, 100}, 180, 180, 100),
            standing_at({0, -150e3, 9e3}, 180, 85, 30)};
}

TEST(Perspective, PixelsComeBackFromEveryDepth) {
    for (const bool curved : {false, true}) {
        for (const Camera& camera : cameras()) {
            const ViewGeometry view(small_spec(100, 16), camera, 4, 800, 600, curved);
            for (const Pixel pixel : {Pixel{0.5, 0.5}, Pixel{400, 300}, Pixel{731, 95}}) {
                for (const double share : {0.01, 0.5, 1.0}) {
                    const double depth = std::lerp(view.near_m(), view.far_m(), share);
                    const Vec3 point = view.point(pixel, depth);
                    EXPECT_NEAR(view.depth_of(point), depth, 1e-6);
                    const Pixel back = view.project(point);
                    EXPECT_NEAR(back.x, pixel.x, 1e-7);
                    EXPECT_NEAR(back.y, pixel.y, 1e-7);
                    const Pixel by_height = view.project(point[0], point[1], view.height_at(point));
                    EXPECT_NEAR(by_height.x, pixel.x, 1e-6);
                    EXPECT_NEAR(by_height.y, pixel.y, 1e-6);
                }
            }
        }
    }
}

TEST(Perspective, GroundIsWhereThePixelLooks) {
    for (const bool curved : {false, true}) {
        int found = 0;
        for (const Camera& camera : cameras()) {
            const ViewGeometry view(small_spec(100, 16), camera, 4, 80, 60, curved);
            for (int y = 0; y < 60; y += 7) {
                for (int x = 0; x < 80; x += 9) {
                    const Pixel pixel{x + 0.5, y + 0.5};
                    const auto ground = view.ground(pixel);
                    if (!ground) continue;
                    ++found;
                    const Pixel back = view.project(ground->x_m, ground->y_m, view.ground_m());
                    ASSERT_NEAR(back.x, pixel.x, 1e-4) << camera.tilt_deg;
                    ASSERT_NEAR(back.y, pixel.y, 1e-4) << camera.tilt_deg;
                }
            }
        }
        EXPECT_GT(found, 150);
    }
}

TEST(Perspective, AboveTheHorizonIsNoGround) {
    const Camera camera = standing_at({0, -100e3, 2e3}, 180, 90, 60);
    for (const bool curved : {false, true}) {
        const ViewGeometry view(small_spec(100, 16), camera, 1, 800, 600, curved);
        EXPECT_FALSE(view.ground({400, 299}));
        EXPECT_FALSE(view.ground({400, 10}));
        EXPECT_TRUE(view.ground({400, 420}));
    }
    const Camera up = standing_at({0, 0, 100}, 180, 180, 60);
    EXPECT_FALSE(ViewGeometry(small_spec(100, 16), up, 1, 80, 60).ground({40, 30}));
}

// From 2 km up, the line of sight touches the parabola of the earth at the horizon, which is sqrt(2
// h / R) below level.
TEST(Perspective, TheHorizonOfACurvedEarthLiesBelowTheLevel) {
    const Camera camera = standing_at({0, 0, 2e3}, 180, 90, 40);
    const ViewGeometry view(small_spec(100, 16), camera, 1, 800, 600, true);
    const double focal = 400 / std::tan(20 * std::numbers::pi / 180);
    const double horizon = 300 + focal * std::sqrt(2 * 2e3 / 6371e3);
    EXPECT_FALSE(view.ground({400, horizon - 0.5}));
    EXPECT_TRUE(view.ground({400, horizon + 0.5}));
}

TEST(Perspective, TheBoxJustFitsIntoThePicture) {
    for (const double field : {20.0, 60.0, 120.0}) {
        for (int azimuth = 0; azimuth < 360; azimuth += 40) {
            for (const double tilt : {0.0, 30.0, 70.0, 90.0}) {
                const ViewGeometry view(small_spec(100, 16), perspective(azimuth, tilt, field), 8,
                                        800, 600);
                double reach = 0;
                for (int corner = 0; corner < 8; ++corner) {
                    const Pixel p = view.project((corner & 1) != 0 ? 50e3 : -50e3,
                                                 (corner & 2) != 0 ? 50e3 : -50e3,
                                                 (corner & 4) != 0 ? view.top_m() : 0);
                    reach = std::max({reach, std::abs(p.x - 400) / 400, std::abs(p.y - 300) / 300});
                }
                EXPECT_LT(reach, 1);
                EXPECT_GT(reach, 0.9);
            }
        }
    }
}

TEST(Perspective, WhatLiesBehindTheCameraHasNoPixel) {
    const ViewGeometry view(small_spec(100, 16), standing_at({0, 0, 3e3}, 180, 90, 60), 1, 80, 60);
    EXPECT_TRUE(std::isnan(view.project(0, -1000, 3e3).x));
    EXPECT_FALSE(std::isnan(view.project(0, 1000, 3e3).x));
}

constexpr double dbz = 41.875 + 0.5 * 0.3125;  // the middle of a bin
grid::BrickGrid homogeneous(const grid::GridSpec& spec) {
    return grid::BrickGrid::from(make_grid_of(spec, [](int, int, int) { return valued(dbz); }),
                                 {1, dbz, 1});
}

Layer slice_from(const grid::BrickView& view, const ViewGeometry& geometry, int slices,
                 double opacity = 1, int threads = 2) {
    return sliced(view, geometry, {slices, Integration::second_order, opacity}, threads);
}

// Looking straight down, the path of a ray through a slab is 1 / cos(its angle) times the
// thickness.
TEST(Perspective, ASlabIsThickerTowardsThePicturesEdge) {
    const grid::GridSpec spec = small_spec(100, 8);
    const auto bricks = homogeneous(spec);
    const ViewGeometry view(spec, perspective(180, 0, 70), 1, 90, 70);
    const double opacity = 0.2;
    const double k = extinction_per_m(nws_reflectivity(), dbz, opacity);
    for (const int slices : {8, 200}) {
        const Layer layer = slice_from(bricks.view(), view, slices, opacity);
        for (const auto& [x, y] : {std::pair{45, 35}, std::pair{30, 20}, std::pair{60, 50}}) {
            const Vec3 along = view.along({x + 0.5, y + 0.5});
            const double path_m = 8 * 500 * std::hypot(along[0], along[1], along[2]);
            EXPECT_NEAR(pixel_of(layer, x, y)[3], 1 - std::exp(-k * path_m), 3e-5) << slices;
        }
    }
}

// A camera inside the box sees as far as its walls.
TEST(Perspective, ACameraInsideSeesUpToTheWalls) {
    const grid::GridSpec spec = small_spec(100, 16);
    const auto bricks = homogeneous(spec);
    const Camera camera = standing_at({20e3, -10e3, 4e3}, 180, 90, 50);
    const ViewGeometry view(spec, camera, 1, 91, 71);
    const double opacity = 0.02;
    const Layer layer = slice_from(bricks.view(), view, 400, opacity);
    const double path_m = 60e3 - view.near_m();  // to the northern wall, straight ahead
    const double k = extinction_per_m(nws_reflectivity(), dbz, opacity);
    EXPECT_NEAR(pixel_of(layer, 45, 35)[3], 1 - std::exp(-k * path_m), 1e-4);
}

TEST(Perspective, EveryCameraAgreesWithTheReference) {
    const grid::GridSpec spec = small_spec(120, 20, 4000, 800);
    const auto bricks = bricks_of(storm_grid(spec));
    for (const bool curved : {false, true}) {
        for (const Camera& camera : cameras()) {
            const ViewGeometry view(spec, camera, 8, 200, 150, curved);
            const Layer layer = slice_from(bricks.view(), view, 1024);
            EXPECT_LT(
                against_reference({bricks.view(), nws_reflectivity(), view, 1}, layer, 4096, 3, 9)
                    .rms,
                0.004)
                << camera.azimuth_deg << " " << camera.tilt_deg << " " << curved;
        }
    }
}

// A layer at 3 km is 960 km wide. The curved earth lowers its edge by 18 km.
TEST(CurvedEarth, AWideLayerBends) {
    const grid::GridSpec spec = small_spec(240, 12, 4000, 500);
    const auto bricks = bricks_of(
        make_grid_of(spec, [](int, int, int iz) { return iz == 5 ? valued(60) : Cell{}; }));
    const auto height_of_echo = [&](const ViewGeometry& view, double x_m) {
        const Layer layer = slice_from(bricks.view(), view, 512);
        const int column = static_cast<int>(view.project(x_m, 0, 3000).x);
        double sum = 0, weighted = 0;
        for (int y = 0; y < layer.height; ++y) {
            const double alpha = pixel_of(layer, column, y)[3];
            sum += alpha;
            weighted += alpha * (y + 0.5);
        }
        EXPECT_GT(sum, 0);
        return weighted / sum;
    };
    for (const bool curved : {false, true}) {
        const ViewGeometry view(spec, Camera{180, 90, 1}, 8, 400, 120, curved);
        for (const double x_m : {0.0, 470e3}) {
            EXPECT_NEAR(height_of_echo(view, x_m), view.project(x_m, 0, 3000).y, 25) << x_m;
        }
        const double bend = height_of_echo(view, 470e3) - height_of_echo(view, 0);
        if (curved) {
            EXPECT_GT(bend, 20);
        } else {
            EXPECT_NEAR(bend, 0, 0.5);
        }
    }
}

}  // namespace
}  // namespace stormcellar::render
