#include "render/view/fitted_camera.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "stormcellar/render/view_geometry.h"
#include "tests/render/synthetic_storm.h"

namespace stormcellar::render {
namespace {

using level2::Moment;

// Returns a cell of a square storm with one value up to 12 km. `radius` is half its side, in cells,
// and (x, y) its middle.
Cell storm_at(int ix, int iy, int iz, int x, int y, int radius, double dbz = 50) {
    const bool inside = std::abs(ix - x) <= radius && std::abs(iy - y) <= radius && iz < 24;
    return inside ? valued(dbz) : Cell{};
}

struct Bounds {
    double left = 1e9, right = -1e9, top = 1e9, bottom = -1e9;
    void add(Pixel p) {
        left = std::min(left, p.x);
        right = std::max(right, p.x);
        top = std::min(top, p.y);
        bottom = std::max(bottom, p.y);
    }
};

// Returns the bounds, in a picture of 640 by 480, of a box of columns from the ground up to 12 km.
Bounds bounds_of(const grid::GridSpec& spec, const Scene& scene, int x, int y, int radius) {
    const ViewGeometry view(spec, scene.camera, scene.vertical_exaggeration, 640, 480,
                            scene.curved_earth);
    Bounds bounds;
    for (const int dx : {-radius, radius}) {
        for (const int dy : {-radius, radius}) {
            for (const double z : {0.0, 12e3})
                bounds.add(
                    view.project(spec.x_from_middle_m(x + dx), spec.y_from_middle_m(y + dy), z));
        }
    }
    return bounds;
}

void expect_inside(const Bounds& bounds) {
    EXPECT_GT(bounds.left, 0);
    EXPECT_LT(bounds.right, 640);
    EXPECT_GT(bounds.top, 0);
    EXPECT_LT(bounds.bottom, 480);
}

TEST(FittedCamera, ShowsAStormWhereverItIs) {
    const grid::GridSpec spec = small_spec(200, 32);
    for (const bool curved : {false, true}) {
        for (const auto& place : {std::pair{40, 60}, {100, 100}, {170, 30}}) {
            const int x = place.first, y = place.second;
            const auto bricks = bricks_of(make_grid_of(
                spec, [&](int ix, int iy, int iz) { return storm_at(ix, iy, iz, x, y, 15); }));
            Scene scene;
            scene.curved_earth = curved;
            const EchoOutline outline(bricks.view(), Moment::ref);
            const FittedView fitted = fit_view(outline, scene, 640, 480);
            EXPECT_TRUE(fitted.has_echo);
            apply(fitted, scene);
            EXPECT_TRUE(validate(scene));
            const Bounds at = bounds_of(spec, scene, x, y, 15);
            expect_inside(at);
            const double filled = std::max((at.right - at.left) / 640, (at.bottom - at.top) / 480);
            EXPECT_NEAR(filled, 0.84, 0.06) << x << " " << y;
            EXPECT_NEAR(scene.vertical_exaggeration, 2, 0.01) << "a storm is seen from near";
        }
    }
}

TEST(FittedCamera, SeesALineFromItsLongSide) {
    const grid::GridSpec spec = small_spec(200, 32);
    const auto azimuth_of = [&](auto line) {
        const auto bricks = bricks_of(make_grid_of(spec, [&](int ix, int iy, int iz) {
            return iz < 24 && line(ix - 100, iy - 100) ? valued(50) : Cell{};
        }));
        return fit_view(EchoOutline(bricks.view(), Moment::ref), {}, 640, 480).camera.azimuth_deg;
    };
    const auto is_short = [](int along) { return std::abs(along) < 80; };
    EXPECT_EQ(azimuth_of([&](int x, int y) { return is_short(x) && std::abs(y) < 8; }), 180);
    // A line from the south-west to the north-east is seen from the south-east.
    EXPECT_NEAR(azimuth_of([&](int x, int y) { return is_short(x) && std::abs(y - x) < 8; }), 135,
                3);
    EXPECT_NEAR(azimuth_of([&](int x, int y) { return is_short(x) && std::abs(y + x) < 8; }), 225,
                3);
    EXPECT_EQ(azimuth_of([&](int x, int y) { return std::hypot(x, y) < 60; }), 180);
}

TEST(FittedCamera, WideEchoIsSeenFromAbove) {
    const grid::GridSpec spec = small_spec(200, 32, 2300);
    const auto bricks = bricks_of(make_grid_of(spec, [&](int ix, int iy, int iz) {
        return iz < 12 && std::hypot(ix - 100, iy - 100) < 95 ? valued(42) : Cell{};
    }));
    const FittedView fitted = fit_view(EchoOutline(bricks.view(), Moment::ref), {}, 640, 480);
    EXPECT_EQ(fitted.camera.tilt_deg, 52);
    EXPECT_GT(fitted.vertical_exaggeration, 3);
    EXPECT_GT(fitted.opacity, 1.5);
}

// On 2026-11-29, the camera also looked at ambiguous cells, which the volume does not show.
TEST(FittedCamera, LooksAtNoAmbiguousCells) {
    const grid::GridSpec spec = small_spec(200, 32);
    const auto fitted = [&](grid::CellStatus elsewhere) {
        const auto grid = make_grid_of(spec, [&](int ix, int iy, int iz) {
            const Cell cell = storm_at(ix, iy, iz, 40, 60, 15);
            return cell.status == grid::CellStatus::value ? cell : Cell{elsewhere, 0};
        });
        const auto bricks = bricks_of(grid, 1, true);
        return fit_view(EchoOutline(bricks.view(), Moment::veld), {}, 640, 480);
    };
    const FittedView clear = fitted(grid::CellStatus::no_echo);
    const FittedView unclear = fitted(grid::CellStatus::ambiguous);
    EXPECT_TRUE(clear.has_echo);
    EXPECT_EQ(unclear.camera.azimuth_deg, clear.camera.azimuth_deg);
    EXPECT_EQ(unclear.camera.tilt_deg, clear.camera.tilt_deg);
    EXPECT_EQ(unclear.camera.zoom, clear.camera.zoom);
    EXPECT_EQ(unclear.vertical_exaggeration, clear.vertical_exaggeration);
}

// These cases could lead to a division by zero: no echo, one cell, nothing seen, one level.
TEST(FittedCamera, IsSaneForWhatIsHardlyThere) {
    const auto check = [](const grid::BrickGrid& bricks, bool has_echo) {
        for (const Moment moment : {Moment::ref, Moment::vel}) {
            for (const bool orbits : {false, true}) {
                Scene scene;
                const FittedView fitted =
                    fit_view(EchoOutline(bricks.view(), moment), scene, 640, 480, {}, orbits);
                EXPECT_EQ(fitted.has_echo, has_echo);
                apply(fitted, scene);
                const Status valid = validate(scene);
                EXPECT_TRUE(valid) << valid.error().message;
                const ViewGeometry view(*bricks.view().spec, scene.camera,
                                        scene.vertical_exaggeration, 640, 480);
                EXPECT_TRUE(std::isfinite(view.near_m()) && view.near_m() < view.far_m());
                EXPECT_TRUE(std::isfinite(turned(fitted, 90).azimuth_deg));
            }
        }
    };
    const grid::GridSpec spec = small_spec(64, 20);
    check(bricks_of(make_grid_of(spec, [](int, int, int) { return Cell{}; })), false);
    check(bricks_of(make_grid_of(spec,
                                 [](int, int, int) {
                                     return Cell{grid::CellStatus::not_seen, 0};
                                 })),
          false);
    check(bricks_of(make_grid_of(spec,
                                 [](int x, int y, int z) {
                                     return x == 32 && y == 10 && z == 5 ? valued(60) : Cell{};
                                 })),
          true);
    check(bricks_of(make_grid_of(spec, [](int, int, int) { return valued(-20); })), true);
    check(bricks_of(make_grid_of(small_spec(3, 1), [](int, int, int) { return valued(40); })),
          true);
}

// A loop's view holds the echo of all its grids.
TEST(FittedCamera, HoldsTheEchoOfAllGrids) {
    const grid::GridSpec spec = small_spec(200, 32);
    EchoOutline outline;
    for (const int x : {30, 100, 170}) {
        outline.add(
            bricks_of(make_grid_of(spec, [&](int ix, int iy,
                                             int iz) { return storm_at(ix, iy, iz, x, 100, 10); }))
                .view(),
            Moment::ref);
    }
    Scene scene;
    apply(fit_view(outline, scene, 640, 480), scene);
    for (const int x : {30, 100, 170}) {
        SCOPED_TRACE(x);
        expect_inside(bounds_of(spec, scene, x, 100, 10));
    }
}

TEST(FittedCamera, AnOrbitKeepsTheStormInThePicture) {
    const grid::GridSpec spec = small_spec(200, 32);
    const auto bricks = bricks_of(make_grid_of(
        spec, [&](int ix, int iy, int iz) { return storm_at(ix, iy, iz, 60, 80, 20); }));
    Scene scene;
    const FittedView fitted =
        fit_view(EchoOutline(bricks.view(), Moment::ref), scene, 640, 480, {}, true);
    apply(fitted, scene);
    for (int turn = 0; turn < 360; turn += 20) {
        scene.camera = turned(fitted, turn);
        SCOPED_TRACE(turn);
        expect_inside(bounds_of(spec, scene, 60, 80, 20));
    }
}

TEST(FittedCamera, WhatIsNotToBeFittedStays) {
    const grid::GridSpec spec = small_spec(100, 32);
    const auto bricks = bricks_of(make_grid_of(
        spec, [&](int ix, int iy, int iz) { return storm_at(ix, iy, iz, 50, 50, 20); }));
    const EchoOutline outline(bricks.view(), Moment::ref);
    Scene scene;
    scene.camera = {77, 33, 1.5};
    scene.vertical_exaggeration = 7;
    scene.opacity = 3;
    FitParts parts = FitParts::none();
    FittedView fitted = fit_view(outline, scene, 640, 480, parts);
    EXPECT_EQ(fitted.camera.azimuth_deg, 77);
    EXPECT_EQ(fitted.camera.tilt_deg, 33);
    EXPECT_EQ(fitted.camera.zoom, 1.5);
    EXPECT_FALSE(fitted.camera.eye);
    EXPECT_EQ(fitted.vertical_exaggeration, 7);
    EXPECT_EQ(fitted.opacity, 3);
    EXPECT_EQ(fitted.sun_azimuth_deg, 225);
    parts.place = parts.field_of_view = true;
    fitted = fit_view(outline, scene, 640, 480, parts);
    EXPECT_EQ(fitted.camera.azimuth_deg, 77);
    EXPECT_TRUE(fitted.camera.eye);
}

TEST(ClearAir, IsEchoWithoutAnythingStronger) {
    const grid::GridSpec spec = small_spec(64, 20);
    const auto clear = [&](double dbz) {
        const auto bricks = bricks_of(
            make_grid_of(spec, [&](int, int, int iz) { return iz < 4 ? valued(dbz) : Cell{}; }));
        return is_clear_air(EchoOutline(bricks.view(), Moment::ref));
    };
    EXPECT_TRUE(clear(-5));
    EXPECT_TRUE(clear(12));
    EXPECT_FALSE(clear(25));
    EXPECT_FALSE(clear(50));
    EXPECT_FALSE(is_clear_air({}));
}

// The echo of the ground about KDMX on a clear day, 90 km2 of 20 dBZ, was drawn with the colors of
// rain, almost black (2026-11-26).
TEST(ClearAir, MayHaveSpecksOfStrongerEcho) {
    const grid::GridSpec spec = small_spec(64, 20);
    const auto clear = [&](double dbz, int side) {
        const auto bricks = bricks_of(make_grid_of(spec, [&](int ix, int iy, int iz) {
            if (iz >= 4) return Cell{};
            return valued(ix < side && iy < side ? dbz : -5);
        }));
        return is_clear_air(EchoOutline(bricks.view(), Moment::ref));
    };
    EXPECT_TRUE(clear(25, 10));
    EXPECT_FALSE(clear(25, 14));
    EXPECT_TRUE(clear(35, 6));
    EXPECT_FALSE(clear(35, 8)) << "this is a small shower";
}

}  // namespace
}  // namespace stormcellar::render
