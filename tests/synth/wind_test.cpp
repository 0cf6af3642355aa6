// Tests each part of a wind against values that are derived by hand, and its derivatives against
// finite differences.
#include "synth/wind.h"

#include <cmath>

#include <gtest/gtest.h>

namespace stormcellar::synth {
namespace {

constexpr double exact = 1e-12;

void expect_wind(const Wind& wind, const Point& point, const Motion& expected, double t_s = 0) {
    const Motion found = wind_at(wind, point, t_s);
    EXPECT_NEAR(found.east_mps, expected.east_mps, exact) << point.x_m << ' ' << point.y_m;
    EXPECT_NEAR(found.north_mps, expected.north_mps, exact) << point.x_m << ' ' << point.y_m;
}

Vortex rankine() {
    Vortex vortex;
    vortex.x_m = 45000;
    vortex.y_m = -5000;
    vortex.radius_m = 10000;
    vortex.tangential_mps = 50;
    return vortex;
}

TEST(Wind, WithoutPartsIsCalm) {
    expect_wind({}, {1000, 2000, 3000}, {0, 0});
}

TEST(Wind, OneLevelIsUniform) {
    const Wind wind{{{2000, {18, -22}}}};
    for (const double z_m : {-500.0, 0.0, 2000.0, 20000.0})
        expect_wind(wind, {7e4, -3e5, z_m}, {18, -22}, 900);
}

TEST(Wind, IsLinearBetweenLevelsAndConstantOutside) {
    const Wind wind{{{1000, {10, 0}}, {3000, {30, -20}}, {4000, {30, 0}}}};
    expect_wind(wind, {0, 0, -500}, {10, 0});
    expect_wind(wind, {0, 0, 1000}, {10, 0});
    expect_wind(wind, {0, 0, 1500}, {15, -5});
    expect_wind(wind, {0, 0, 3000}, {30, -20});
    expect_wind(wind, {0, 0, 3250}, {30, -15});
    expect_wind(wind, {0, 0, 4000}, {30, 0});
    expect_wind(wind, {0, 0, 30000}, {30, 0});
}

TEST(Wind, LevelsOfOneHeightAreAStep) {
    const Wind wind{{{1000, {10, 0}}, {1000, {20, 0}}}};
    expect_wind(wind, {0, 0, 999}, {10, 0});
    expect_wind(wind, {0, 0, 1000}, {20, 0});
}

TEST(Wind, ARankineVortexTurnsCounterclockwise) {
    const Wind wind{{}, {rankine()}};
    expect_wind(wind, {45000, -5000, 0}, {0, 0});
    expect_wind(wind, {50000, -5000, 0}, {0, 25});      // half the radius east of the center
    expect_wind(wind, {45000, 5000, 0}, {-50, 0});      // on the radius
    expect_wind(wind, {25000, -5000, 0}, {0, -25});     // twice the radius
    expect_wind(wind, {57000, 11000, 0}, {-20, 15});    // 12 km east and 16 km north of the center
    expect_wind(wind, {45000, -1005000, 0}, {0.5, 0});  // 1,000 km south of the center
    Vortex clockwise = rankine();
    clockwise.tangential_mps = -50;
    expect_wind({{}, {clockwise}}, {57000, 11000, 0}, {20, -15});
}

TEST(Wind, AHurricaneDecaysSlowlyAndDrawsAirIn) {
    Vortex hurricane = rankine();
    hurricane.decay = 0.5;
    hurricane.radial_mps = -10;
    const Wind wind{{}, {hurricane}};
    // At four times the radius, both parts have half of their greatest values.
    expect_wind(wind, {85000, -5000, 0}, {-5, 25});
    expect_wind(wind, {45000, -8000, 0}, {15, 3});  // 0.3 radii south of the center
}

TEST(Wind, AVortexDriftsAndEndsAtItsBaseAndTop) {
    Vortex vortex = rankine();
    vortex.motion = {20, -10};
    vortex.base_m = 500;
    vortex.top_m = 8000;
    const Wind wind{{}, {vortex}};
    expect_wind(wind, {47000, 4000, 3000}, {-50, 0}, 100);
    expect_wind(wind, {45000, 5000, 500}, {-50, 0});
    expect_wind(wind, {45000, 5000, 8000}, {-50, 0});
    expect_wind(wind, {45000, 5000, 499}, {0, 0});
    expect_wind(wind, {45000, 5000, 8001}, {0, 0});
}

TEST(Wind, AVortexWithoutARadiusIsCalm) {
    for (const double radius_m : {0.0, -1.0, std::nan("")}) {
        Vortex vortex = rankine();
        vortex.radius_m = radius_m;
        expect_wind({{}, {vortex}}, {45000, -5000, 0}, {0, 0});
        expect_wind({{}, {vortex}}, {46000, -5000, 0}, {0, 0});
    }
}

TEST(Wind, PartsAddUp) {
    Vortex mesocyclone = rankine();
    Vortex microburst;
    microburst.x_m = 40000;
    microburst.radial_mps = 15;
    microburst.decay = 2;
    const Wind shear{{{0, {3, 8}}, {8000, {45, 0}}}};
    const Wind all{shear.levels, {mesocyclone, microburst}};
    for (const Point& point : {Point{40000, 0, 0}, {40500, 100, 2000}, {48000, 3000, 9000}}) {
        Motion sum = wind_at(shear, point, 60);
        for (const Vortex& vortex : all.vortices) {
            const Motion own = wind_at({{}, {vortex}}, point, 60);
            sum.east_mps += own.east_mps;
            sum.north_mps += own.north_mps;
        }
        expect_wind(all, point, sum, 60);
    }
}

struct Derivatives {
    double divergence_per_s = 0;
    double vorticity_per_s = 0;
};
Derivatives derivatives_at(const Wind& wind, const Point& point) {
    constexpr double step_m = 1;
    const auto at = [&](double east_m, double north_m) {
        return wind_at(wind, {point.x_m + east_m, point.y_m + north_m, point.z_m}, 0);
    };
    const Motion east = at(step_m, 0), west = at(-step_m, 0);
    const Motion north = at(0, step_m), south = at(0, -step_m);
    return {(east.east_mps - west.east_mps + north.north_mps - south.north_mps) / (2 * step_m),
            (east.north_mps - west.north_mps - north.east_mps + south.east_mps) / (2 * step_m)};
}

// The largest third derivative, 6 * 50 m/s * 10 km / (12 km)^4, lets the difference err by 1e-10/s.
TEST(Wind, AVortexHasItsVorticityAndDivergenceOnlyWithin) {
    Vortex vortex = rankine();
    vortex.radial_mps = -8;
    const Wind wind{{}, {vortex}};
    for (double azimuth = 0; azimuth < 6.28; azimuth += 0.7) {
        for (const double radius_m : {0.0, 1e-9, 3.0, 9000.0, 12000.0, 300000.0}) {
            const Point point{45000 + radius_m * std::sin(azimuth),
                              -5000 + radius_m * std::cos(azimuth), 0};
            const Derivatives found = derivatives_at(wind, point);
            const bool inside = radius_m < 10000;
            EXPECT_NEAR(found.vorticity_per_s, inside ? 2 * 50.0 / 10000 : 0, 2e-10) << radius_m;
            EXPECT_NEAR(found.divergence_per_s, inside ? 2 * -8.0 / 10000 : 0, 2e-10) << radius_m;
        }
    }
}

// Beyond the radius the vorticity is (1 - decay) V / r.
TEST(Wind, AVortexWithoutInflowHasNoDivergenceWhateverItsDecay) {
    for (const double decay : {0.0, 0.5, 1.0, 1.7}) {
        Vortex vortex = rankine();
        vortex.decay = decay;
        for (const double radius_m : {4000.0, 15000.0, 40000.0}) {
            const Point point{45000 + 0.6 * radius_m, -5000 - 0.8 * radius_m, 0};
            const Derivatives found = derivatives_at({{}, {vortex}}, point);
            const double speed_mps = 50 * std::pow(10000 / radius_m, decay);
            const double vorticity_per_s =
                radius_m < 10000 ? 0.01 : (1 - decay) * speed_mps / radius_m;
            EXPECT_NEAR(found.divergence_per_s, 0, 2e-10) << decay << ' ' << radius_m;
            EXPECT_NEAR(found.vorticity_per_s, vorticity_per_s, 2e-10) << decay << ' ' << radius_m;
        }
    }
}

TEST(Wind, TheRadarSeesThePartAlongItsBeam) {
    EXPECT_NEAR(away_mps({30, 40}, 0, 0), 40, exact);
    EXPECT_NEAR(away_mps({30, 40}, 90, 60), 15, exact);
    EXPECT_NEAR(away_mps({30, 40}, 210, 0), -15 - 20 * std::sqrt(3.0), exact);
    EXPECT_NEAR(away_mps({30, 40}, 77, 90), 0, exact);
}

// A vortex around the radar is across every beam, so a radar in its center sees inflow alone.
TEST(Wind, AVortexAroundTheRadarShowsItsInflowAlone) {
    Vortex vortex;
    vortex.tangential_mps = 40;
    vortex.radial_mps = -6;
    vortex.radius_m = 3000;
    for (double azimuth_deg = 0; azimuth_deg < 360; azimuth_deg += 15) {
        for (const auto& [range_m, expected_mps] :
             {std::pair{0.0, 0.0}, {1500.0, -3.0}, {3000.0, -6.0}, {9000.0, -2.0}}) {
            const Point point{range_m * std::sin(azimuth_deg * degree),
                              range_m * std::cos(azimuth_deg * degree), 0};
            EXPECT_NEAR(away_mps(wind_at({{}, {vortex}}, point, 0), azimuth_deg, 0), expected_mps,
                        exact);
        }
    }
}

TEST(Wind, SeenFromAnotherPlaceIsTheSameWind) {
    Vortex vortex = rankine();
    vortex.radial_mps = -10;
    vortex.motion = {12, -5};
    const Wind wind{{{0, {3, 8}}, {8000, {45, 0}}}, {vortex}};
    const Stand stand{15000, -40000, 90};
    // North in the new plane is east in the old plane.
    const Wind there = seen_from(wind, stand);
    for (const Point& point : {Point{30000, 35000, 0}, {-38000, 29000, 4000}}) {
        const Motion old = wind_at(wind, {15000 + point.y_m, -40000 - point.x_m, point.z_m}, 200);
        const Motion found = wind_at(there, point, 200);
        EXPECT_NEAR(found.north_mps, old.east_mps, 1e-9);
        EXPECT_NEAR(found.east_mps, -old.north_mps, 1e-9);
    }
}

}  // namespace
}  // namespace stormcellar::synth
