#include "render/view/camera_path.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "stormcellar/render/view_geometry.h"
#include "tests/render/synthetic_storm.h"

namespace stormcellar::render {
namespace {

CameraKey at_place(double time_s, Eye eye, Eye look_at) {
    CameraKey key;
    key.time_s = time_s;
    key.eye = eye;
    key.look_at = look_at;
    return key;
}

CameraKey from(double time_s, double azimuth_deg, int turns = 0) {
    CameraKey key;
    key.time_s = time_s;
    key.azimuth_deg = azimuth_deg;
    key.turns = turns;
    return key;
}

CameraPath path_of(const std::vector<CameraKey>& keys) {
    auto path = CameraPath::make(keys, {});
    EXPECT_TRUE(path) << path.error().message;
    return *path;
}

std::string refusal(const std::vector<CameraKey>& keys) {
    const auto path = CameraPath::make(keys, {});
    return path ? std::string{"none"} : path.error().message;
}

const std::vector<CameraKey> flight = {at_place(0, {-90e3, -60e3, 30e3}, {0, 0, 5e3}),
                                       at_place(4, {-20e3, -40e3, 2e3}, {0, 0, 5e3}),
                                       at_place(5, {20e3, -35e3, 1e3}, {5e3, 0, 6e3}),
                                       at_place(12, {70e3, 50e3, 25e3}, {0, 10e3, 4e3})};

TEST(CameraPath, PassesThroughItsKeysAtTheirTimes) {
    const CameraPath path = path_of(flight);
    EXPECT_EQ(path.duration_s(), 12);
    EXPECT_FALSE(path.is_closed());
    for (const CameraKey& key : flight) {
        const Camera camera = path.at(key.time_s / 12);
        EXPECT_NEAR(camera.eye->x_m, key.eye->x_m, 1e-6);
        EXPECT_NEAR(camera.eye->y_m, key.eye->y_m, 1e-6);
        EXPECT_NEAR(camera.eye->height_m, key.eye->height_m, 1e-6);
        EXPECT_NEAR(camera.look_at->x_m, key.look_at->x_m, 1e-6);
        EXPECT_NEAR(camera.look_at->height_m, key.look_at->height_m, 1e-6);
    }
}

TEST(CameraPath, GoesWithoutAJerkAndStartsAndEndsAtRest) {
    const CameraPath path = path_of(flight);
    constexpr int steps = 12'000;
    const auto velocity = [&](int step, double Eye::*part) {
        const double h = 1e-6;
        const double share = static_cast<double>(step) / steps;
        const double a = (*path.at(std::max(share - h, 0.0)).eye).*part;
        const double b = (*path.at(std::min(share + h, 1.0)).eye).*part;
        return (b - a) / (2 * h);
    };
    for (double Eye::*part : {&Eye::x_m, &Eye::y_m, &Eye::height_m}) {
        double fastest = 0, largest_jump = 0;
        for (int step = 1; step < steps; ++step) {
            fastest = std::max(fastest, std::abs(velocity(step, part)));
            largest_jump =
                std::max(largest_jump, std::abs(velocity(step, part) - velocity(step - 1, part)));
        }
        // A kink would change the velocity by a large share within one step.
        EXPECT_LT(largest_jump, 0.01 * fastest);
        EXPECT_LT(std::abs(velocity(0, part)), 0.01 * fastest);
        EXPECT_LT(std::abs(velocity(steps, part)), 0.01 * fastest);
    }
}

TEST(CameraPath, HeightsStayBetweenThoseOfTheKeysAround) {
    const CameraPath path = path_of(flight);
    for (std::size_t i = 0; i + 1 < flight.size(); ++i) {
        const auto [low, high] = std::minmax(flight[i].eye->height_m, flight[i + 1].eye->height_m);
        for (int step = 0; step <= 100; ++step) {
            const double time_s =
                flight[i].time_s + (flight[i + 1].time_s - flight[i].time_s) * step / 100.0;
            const double height_m = path.at(time_s / 12).eye->height_m;
            EXPECT_GE(height_m, low - 1e-6);
            EXPECT_LE(height_m, high + 1e-6);
        }
    }
}

TEST(CameraPath, HoldsStillBetweenEqualPlaces) {
    const Eye here{10e3, 10e3, 5e3};
    const CameraPath path = path_of({at_place(0, {-50e3, 0, 5e3}, {}), at_place(2, here, {}),
                                     at_place(3, here, {}), at_place(5, {60e3, 30e3, 9e3}, {})});
    for (const double time_s : {2.0, 2.2, 2.5, 3.0}) {
        EXPECT_NEAR(path.at(time_s / 5).eye->x_m, 10e3, 1e-6);
        EXPECT_NEAR(path.at(time_s / 5).eye->y_m, 10e3, 1e-6);
    }
}

TEST(CameraPath, TakesTheShortestWayRoundUnlessTurnsAreAskedFor) {
    const CameraPath across_north = path_of({from(0, 350), from(1, 20)});
    EXPECT_NEAR(across_north.at(0.5).azimuth_deg, 365, 1e-9);
    const CameraPath back = path_of({from(0, 20), from(1, -10)});
    EXPECT_NEAR(back.at(1).azimuth_deg, -10, 1e-9);
    const CameraPath once = path_of({from(0, 180), from(1, 180, 1)});
    EXPECT_TRUE(once.is_closed());
    // A path that ends where it began turns at a constant rate.
    EXPECT_NEAR(once.at(0.25).azimuth_deg, 270, 1e-9);
    EXPECT_NEAR(once.at(0.5).azimuth_deg, 360, 1e-9);
    const CameraPath other_way = path_of({from(0, 180), from(1, 90, -1)});
    EXPECT_NEAR(other_way.at(1).azimuth_deg, -270, 1e-9);
}

TEST(CameraPath, WhatAKeyLeavesOutIsThatOfTheUsualCamera) {
    Camera usual;
    usual.tilt_deg = 70;
    usual.field_of_view_deg = 40;
    CameraKey zoomed = from(1, 90);
    zoomed.zoom = 4;
    const auto path = CameraPath::make({from(0, 0), zoomed}, usual);
    ASSERT_TRUE(path);
    const Camera middle = path->at(0.5);
    EXPECT_NEAR(middle.azimuth_deg, 45, 1e-9);
    EXPECT_NEAR(middle.tilt_deg, 70, 1e-9);
    EXPECT_NEAR(middle.field_of_view_deg, 40, 1e-9);
    EXPECT_NEAR(middle.zoom, 2, 1e-9);
}

TEST(CameraPath, RefusesWhatMakesNoSenseAndNamesTheKey) {
    EXPECT_NE(refusal({from(0, 0)}).find("two keys"), std::string::npos);
    EXPECT_NE(refusal({from(0, 0), from(0, 90)}).find("key 2"), std::string::npos);
    EXPECT_NE(refusal({from(0, 0), at_place(1, {0, 0, 9e3}, {})}).find("at_km"), std::string::npos);
    CameraKey both = at_place(1, {0, 0, 9e3}, {});
    both.tilt_deg = 20;
    EXPECT_NE(refusal({at_place(0, {0, 1e3, 9e3}, {}), both}).find("tilt_deg"), std::string::npos);
    EXPECT_NE(refusal({at_place(0, {0, 0, 9e3}, {0, 0, 9e3}), at_place(1, {0, 1e3, 9e3}, {})})
                  .find("key 1"),
              std::string::npos);
    EXPECT_NE(refusal({from(0, 0, 1), from(1, 90)}).find("turns"), std::string::npos);
}

TEST(ViewGeometry, ACameraLooksAtItsPoint) {
    const grid::GridSpec spec = small_spec(100, 16);
    const Eye point{20e3, -12e3, 4e3};
    for (const bool curved : {false, true}) {
        for (const Eye& eye : {Eye{-80e3, 30e3, 1e3}, Eye{25e3, -90e3, 60e3},
                               Eye{20e3, -12e3, 40e3}, Eye{60e3, 50e3, 0}}) {
            Camera camera;
            camera.eye = eye;
            camera.look_at = point;
            camera.field_of_view_deg = 50;
            const ViewGeometry view(spec, camera, 3, 800, 600, curved);
            const Pixel middle = view.project(point.x_m, point.y_m, point.height_m);
            EXPECT_NEAR(middle.x, 400, 1e-6);
            EXPECT_NEAR(middle.y, 300, 1e-6);
        }
        for (const double field_of_view_deg : {0.0, 40.0}) {
            Camera camera{230, 60, 2, field_of_view_deg};
            camera.look_at = point;
            const ViewGeometry view(spec, camera, 3, 800, 600, curved);
            const Pixel middle = view.project(point.x_m, point.y_m, point.height_m);
            EXPECT_NEAR(middle.x, 400, 1e-6);
            EXPECT_NEAR(middle.y, 300, 1e-6);
        }
    }
}

}  // namespace
}  // namespace stormcellar::render
