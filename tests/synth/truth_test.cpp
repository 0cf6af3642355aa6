#include "synth/truth.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace stormcellar::synth {
namespace {

Storm round_storm() {
    Storm storm;
    storm.footprint.major_m = 20000;
    storm.footprint.minor_m = 10000;
    storm.core_m = 4000;
    storm.top_m = 12000;
    storm.peak_dbz = 60;
    return storm;
}

Weather only(const Storm& storm) {
    return {{storm}, {}};
}
Weather only(const Layer& layer) {
    return {{}, {layer}};
}

TEST(TruthStorm, IsStrongestInItsCoreAndTenAtItsEdges) {
    const Weather weather = only(round_storm());
    EXPECT_DOUBLE_EQ(truth_dbz(weather, {0, 0, 4000}, 0), 60);
    EXPECT_NEAR(truth_dbz(weather, {0, 0, 0}, 0), 60, 1e-9)
        << "the echo is no weaker below the core";
    EXPECT_NEAR(truth_dbz(weather, {0, 20000, 4000}, 0), 10, 1e-9);
    EXPECT_NEAR(truth_dbz(weather, {-10000, 0, 4000}, 0), 10, 1e-9);
    EXPECT_NEAR(truth_dbz(weather, {0, 0, 12000}, 0), 10, 1e-9);
    // Halfway to the radius, a quarter of the decrease has happened: 60 - 50 / 4.
    EXPECT_NEAR(truth_dbz(weather, {5000, 0, 4000}, 0), 47.5, 1e-9);
}

TEST(TruthStorm, EndsWhereItFallsBelowMinusTwenty) {
    const Weather weather = only(round_storm());
    // 60 - 50 r^2 = -20 at r = 1.2649.
    EXPECT_NEAR(truth_dbz(weather, {12640, 0, 4000}, 0), -19.88, 0.01);
    EXPECT_EQ(truth_dbz(weather, {12660, 0, 4000}, 0), -INFINITY);
}

TEST(TruthStorm, ItsMajorAxisPointsAlongTheAzimuth) {
    Storm storm = round_storm();
    storm.footprint.orientation_deg = 60;
    const double edge_east_m = 20000 * std::sin(M_PI / 3);
    const double edge_north_m = 20000 * std::cos(M_PI / 3);
    EXPECT_NEAR(truth_dbz(only(storm), {edge_east_m, edge_north_m, 4000}, 0), 10, 1e-9);
    EXPECT_LT(truth_dbz(only(storm), {edge_east_m, -edge_north_m, 4000}, 0), 0);
}

TEST(TruthStorm, DriftsAndLeans) {
    Storm storm = round_storm();
    storm.footprint.x_m = -30000;
    storm.footprint.y_m = 7000;
    storm.footprint.motion = {20, -10};
    storm.tilt_east = 0.5;
    storm.tilt_north = 1;
    const Weather weather = only(storm);
    EXPECT_NEAR(truth_dbz(weather, {-30000, 7000, 4000}, 0), 60, 1e-9);
    EXPECT_NEAR(truth_dbz(weather, {-28000, 6000, 4000}, 100), 60, 1e-9);
    // 8 km above the core, the axis is 4 km farther east and 8 km farther north.
    EXPECT_NEAR(truth_dbz(weather, {-26000, 15000, 12000}, 0), 10, 1e-9);
    EXPECT_NEAR(truth_dbz(weather, {-32000, 3000, 0}, 0), 60, 1e-9);
}

TEST(TruthStorm, ItsRippleIsBoundedAndMovesWithIt) {
    Storm storm = round_storm();
    storm.footprint.motion = {10, 0};
    const Weather smooth = only(storm);
    storm.ripple = {6, 4000};
    const Weather rippled = only(storm);
    double most_db = 0;
    for (int x_m = -5000; x_m <= 5000; x_m += 130) {
        const double change_db = truth_dbz(rippled, {1.0 * x_m, 300, 4000}, 0) -
                                 truth_dbz(smooth, {1.0 * x_m, 300, 4000}, 0);
        EXPECT_LE(std::abs(change_db), 6);
        most_db = std::max(most_db, std::abs(change_db));
        EXPECT_NEAR(truth_dbz(rippled, {x_m + 1000.0, 300, 4000}, 100),
                    truth_dbz(rippled, {1.0 * x_m, 300, 4000}, 0), 1e-9);
    }
    EXPECT_GT(most_db, 3);
}

TEST(TruthHook, FollowsItsArcAndLeavesTheGap) {
    Storm storm = round_storm();
    storm.footprint.major_m = storm.footprint.minor_m = 1000;  // out of the way
    storm.hook = Hook{-20000, 0, 5000, 90, 360, 1000, 6000, 50};
    const Weather weather = only(storm);
    // The points are on the arc in the south, one width away from the arc, and at the top of the
    // arc.
    EXPECT_NEAR(truth_dbz(weather, {-20000, -5000, 0}, 0), 50, 1e-9);
    EXPECT_NEAR(truth_dbz(weather, {-20000, -6000, 0}, 0), 10, 1e-9);
    EXPECT_NEAR(truth_dbz(weather, {-20000, -5000, 6000}, 0), 10, 1e-9);
    // The ends are at azimuths 90 and 0; the gap is northeast of the center.
    EXPECT_NEAR(truth_dbz(weather, {-15000, 0, 0}, 0), 50, 1e-9);
    EXPECT_NEAR(truth_dbz(weather, {-20000, 5000, 0}, 0), 50, 1e-9);
    const double diagonal_m = 5000 / std::sqrt(2);
    EXPECT_EQ(truth_dbz(weather, {-20000 + diagonal_m, diagonal_m, 0}, 0), -INFINITY);
    EXPECT_NEAR(truth_dbz(weather, {-20000 - diagonal_m, diagonal_m, 0}, 0), 50, 1e-9);
}

TEST(TruthLayer, HasABrightBandAndFallsAboveIt) {
    Layer layer;
    layer.base_m = 500;
    layer.top_m = 8000;
    layer.peak_dbz = 25;
    layer.melting_m = 3000;
    layer.bright_band_db = 8;
    layer.bright_band_depth_m = 300;
    layer.lapse_db_per_m = 0.004;
    const Weather weather = only(layer);
    EXPECT_NEAR(truth_dbz(weather, {0, 0, 1000}, 0), 25, 1e-9);
    EXPECT_NEAR(truth_dbz(weather, {0, 0, 3000}, 0), 33, 1e-9);
    EXPECT_NEAR(truth_dbz(weather, {0, 0, 6000}, 0), 13, 1e-9);
    EXPECT_NEAR(truth_dbz(weather, {10000, 0, 1000}, 0), 10, 1e-9);
    EXPECT_EQ(truth_dbz(weather, {0, 0, 499}, 0), -INFINITY);
    EXPECT_EQ(truth_dbz(weather, {0, 0, 8001}, 0), -INFINITY);
}

TEST(Truth, FeaturesAddInLinearUnitsAndWeighTheirMotion) {
    Storm east = round_storm();
    east.footprint.motion = {30, 0};
    Storm north = round_storm();
    north.footprint.motion = {0, 15};
    const Echo equal = truth({{east, north}, {}}, {0, 0, 4000}, 0);
    EXPECT_NEAR(equal.dbz, 60 + 10 * std::log10(2), 1e-9);
    EXPECT_NEAR(equal.motion.east_mps, 15, 1e-9);
    EXPECT_NEAR(equal.motion.north_mps, 7.5, 1e-9);
    north.peak_dbz = 50;  // a tenth of the power of `east`
    const Echo unequal = truth({{east, north}, {}}, {0, 0, 4000}, 0);
    EXPECT_NEAR(unequal.motion.east_mps, 30 / 1.1, 1e-9);
    EXPECT_NEAR(unequal.motion.north_mps, 1.5 / 1.1, 1e-9);
    EXPECT_EQ(truth({}, {0, 0, 0}, 0).dbz, -INFINITY);
}

TEST(Truth, NothingLiesBeyondTheDiscsOrAboveTheCeiling) {
    Storm storm = round_storm();
    storm.footprint.motion = {20, 16};
    storm.footprint.orientation_deg = 30;
    storm.tilt_east = 1.5;
    storm.tilt_north = -0.4;
    storm.ripple = {5, 6000};
    storm.hook = Hook{-9000, -15000, 8000, 120, 350, 3000, 7000, 55};
    Layer layer;
    layer.footprint.x_m = 50000;
    layer.bright_band_db = 9;
    layer.ripple = {4, 9000};
    const Weather weather{{storm}, {layer}};
    std::mt19937_64 random(20240601);
    std::uniform_real_distribution<double> place(-90000, 90000);
    std::uniform_real_distribution<double> height(-400, 25000);
    std::uniform_real_distribution<double> time(0, 1000);
    int with_echo = 0;
    for (int i = 0; i < 300000; ++i) {
        const Point point{place(random), place(random), height(random)};
        const double t_s = time(random);
        if (truth_dbz(weather, point, t_s) == -INFINITY) continue;
        ++with_echo;
        ASSERT_LE(point.z_m, echo_ceiling_m(weather));
        bool inside = false;
        for (const Disc& disc : echo_discs(weather, t_s)) {
            const double distance_m = std::hypot(point.x_m - disc.x_m, point.y_m - disc.y_m);
            inside = inside || distance_m <= disc.radius_m;
        }
        ASSERT_TRUE(inside) << point.x_m << ' ' << point.y_m << ' ' << point.z_m << ' ' << t_s;
    }
    EXPECT_GT(with_echo, 5000);
}

TEST(TruthBox, IsFlatAndFallsBeyondItsSides) {
    Box box;
    box.footprint.x_m = 1000;
    box.footprint.motion = {10, 0};
    box.footprint.major_m = 20000;
    box.footprint.minor_m = 10000;
    box.base_m = 2000;
    box.top_m = 6000;
    box.edge_m = 50;
    const Weather weather{{}, {}, {box}};
    EXPECT_DOUBLE_EQ(truth_dbz(weather, {1000 + 9999, 19999, 2000}, 0), 40);
    EXPECT_NEAR(truth_dbz(weather, {1000, 20050, 3000}, 0), 10, 1e-9);
    EXPECT_NEAR(truth_dbz(weather, {1000 + 10025, 0, 3000}, 0), 40 - 30.0 / 4, 1e-9);
    // This point is 30 m east and 40 m north of a corner, so 50 m from the box.
    EXPECT_NEAR(truth_dbz(weather, {1000 + 10030, 20040, 3000}, 0), 10, 1e-9);
    EXPECT_NEAR(truth_dbz(weather, {1000 + 10050 + 100, 0, 3000}, 10), 10, 1e-9)
        << "the box drifts";
    EXPECT_EQ(truth_dbz(weather, {1000, 0, 1999}, 0), -INFINITY);
    EXPECT_EQ(truth_dbz(weather, {1000, 0, 6001}, 0), -INFINITY);
    EXPECT_EQ(truth_dbz(weather, {1000, 20080, 3000}, 0), -INFINITY);
    EXPECT_EQ(echo_ceiling_m(weather), 6000);
    EXPECT_GE(echo_discs(weather, 0)[0].radius_m, std::hypot(20000, 10000) + 70);
    const LinearEcho echo = linear_truth(weather, {1000, 0, 3000}, 0);
    EXPECT_DOUBLE_EQ(echo.z_mm6_m3, 10000);
    EXPECT_EQ(echo.motion.east_mps, 10);
}

TEST(TruthBox, ItsWaveRunsAlongItsAzimuth) {
    Box box;
    box.footprint.major_m = box.footprint.minor_m = 50000;
    box.footprint.motion = {5, 5};
    box.wave = {6, 8000, 60};
    const Weather weather{{}, {}, {box}};
    const double east = std::sin(M_PI / 3);
    const double north = std::cos(M_PI / 3);
    EXPECT_NEAR(truth_dbz(weather, {2000 * east, 2000 * north, 100}, 0), 46, 1e-9);
    EXPECT_NEAR(truth_dbz(weather, {-2000 * east, -2000 * north, 100}, 0), 34, 1e-9);
    EXPECT_NEAR(truth_dbz(weather, {9000 * north, -9000 * east, 100}, 0), 40, 1e-9);
    EXPECT_NEAR(truth_dbz(weather, {2000 * east + 50, 2000 * north + 50, 100}, 10), 46, 1e-9);
}

TEST(Truth, TheAirMovesWithTheWindAndTheEchoWithItsFeature) {
    Storm storm = round_storm();
    storm.footprint.motion = {20, -7};
    Weather weather{{storm}, {}};
    const Point later{storm.footprint.x_m + 2000, storm.footprint.y_m - 700, 1000};
    const Echo without = truth(weather, later, 100);
    weather.wind = Wind{{{0, {3, 40}}, {2000, {5, 60}}}};
    const Echo with = truth(weather, later, 100);
    EXPECT_DOUBLE_EQ(with.dbz, without.dbz);
    EXPECT_NEAR(without.motion.east_mps, 20, 1e-12);
    EXPECT_NEAR(with.motion.east_mps, 4, 1e-12);
    EXPECT_NEAR(linear_truth(weather, later, 100).motion.north_mps, 50, 1e-12);
    EXPECT_EQ(truth(weather, {900000, 0, 1000}, 0).motion.north_mps, 0)
        << "without echo there is no motion";
    const Weather turned = seen_from(weather, {0, 0, 90});  // north in the turned plane is east
    EXPECT_NEAR(truth(turned, {-later.y_m, later.x_m, 1000}, 100).motion.north_mps, 4, 1e-9);
}

// Everything that has a direction turns with the plane: hooks, tilts, ripples, waves, motions.
TEST(Truth, SeenFromAnotherPlaceIsTheSameWeather) {
    Storm storm = round_storm();
    storm.footprint.x_m = 30000;
    storm.footprint.y_m = -5000;
    storm.footprint.motion = {20, -7};
    storm.footprint.orientation_deg = 35;
    storm.tilt_east = 0.7;
    storm.tilt_north = -0.2;
    storm.ripple = {4, 9000};
    storm.hook = Hook{-6000, -11000, 5000, 125, 350, 2200, 6000, 54};
    Layer layer;
    layer.footprint.x_m = -20000;
    layer.footprint.major_m = 60000;
    layer.footprint.minor_m = 30000;
    layer.footprint.orientation_deg = 70;
    layer.ripple = {3, 14000};
    Box box;
    box.footprint.y_m = 40000;
    box.footprint.orientation_deg = 20;
    box.wave = {6, 8000, 60};
    const Weather weather{{storm}, {layer}, {box}};
    const Stand stand{15000, -40000, 12};
    const Weather there = seen_from(weather, stand);
    const double turn = stand.turn_deg * M_PI / 180;
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(-70000, 70000);
    int with_echo = 0;
    for (int i = 0; i < 2000; ++i) {
        const Point point{place(random), place(random), 0.05 * std::abs(place(random))};
        // The axes of the new plane are the axes of the old plane, turned clockwise.
        const double east = point.x_m * std::cos(turn) + point.y_m * std::sin(turn) + stand.x_m;
        const double north = point.y_m * std::cos(turn) - point.x_m * std::sin(turn) + stand.y_m;
        const Echo here = truth(weather, {east, north, point.z_m}, 100);
        const Echo moved = truth(there, point, 100);
        if (std::isinf(here.dbz)) {
            EXPECT_TRUE(std::isinf(moved.dbz));
            continue;
        }
        ++with_echo;
        EXPECT_NEAR(moved.dbz, here.dbz, 1e-6);
        EXPECT_NEAR(
            moved.motion.east_mps * std::cos(turn) + moved.motion.north_mps * std::sin(turn),
            here.motion.east_mps, 1e-6);
        EXPECT_NEAR(
            moved.motion.north_mps * std::cos(turn) - moved.motion.east_mps * std::sin(turn),
            here.motion.north_mps, 1e-6);
    }
    EXPECT_GT(with_echo, 500);
}

}  // namespace
}  // namespace stormcellar::synth
