#include "grid/plan/cell_circle.h"

#include <gtest/gtest.h>

#include "tests/grid/volume_maker.h"

namespace stormcellar::grid {
namespace {

const SitePosition centre{"KTLX", 35, -97, 0};

// Returns sweeps at 0.5 and 2.5 degrees, whose heights at 60 km are about 0.7 and 2.8 km.
level2::Volume volume_of(level2::Moment moment, float lower_mps, float upper_mps) {
    SweepPlan lower{.moment = moment};
    SweepPlan upper = lower;
    upper.elevation_deg = 2.5;
    auto volume = make_volume({lower, upper});
    for (level2::Radial& radial : volume.sweeps[0].radials)
        radial.nyquist_mps = lower_mps;
    for (level2::Radial& radial : volume.sweeps[1].radials)
        radial.nyquist_mps = upper_mps;
    return volume;
}

// Differences of two values at 60 km, at heights below, between and above the beams.
struct Differences {
    double below = 0, between = 0, above = 0;
};
Differences differences(const level2::Volume& volume, level2::Moment moment, float a, float b) {
    GridSpec spec = default_spec(centre.latitude_deg, centre.longitude_deg);
    spec.levels_m = {300, 2000, 4000};
    const auto chosen = choose_sweeps(volume, moment, 0.475);
    CellCircles circles(volume, chosen, centre, spec, moment);
    circles.move_to(60e3);
    return {circles.difference(a, b, 0), circles.difference(a, b, 1), circles.difference(a, b, 2)};
}

TEST(CellCircles, VelocitiesDifferByTheShorterWayRound) {
    const auto volume = volume_of(level2::Moment::vel, 25, 25);
    const Differences folded = differences(volume, level2::Moment::vel, 24.5F, -24.5F);
    EXPECT_DOUBLE_EQ(folded.below, -1);
    EXPECT_DOUBLE_EQ(folded.between, -1);
    EXPECT_DOUBLE_EQ(folded.above, -1);
    EXPECT_DOUBLE_EQ(differences(volume, level2::Moment::vel, 3, -3).between, 6);
}

TEST(CellCircles, BetweenDifferentCirclesTheLongerWayCounts) {
    const auto volume = volume_of(level2::Moment::vel, 25, 30);
    const Differences folded = differences(volume, level2::Moment::vel, 25, -25);
    EXPECT_DOUBLE_EQ(folded.below, 0);
    EXPECT_DOUBLE_EQ(folded.between, -10);
    EXPECT_DOUBLE_EQ(folded.above, -10);
}

TEST(CellCircles, WithoutACircleValuesAreNumbers) {
    const auto unknown = volume_of(level2::Moment::vel, 0, 0);
    EXPECT_DOUBLE_EQ(differences(unknown, level2::Moment::vel, 25, -25).between, 50);
    const auto reflectivity = volume_of(level2::Moment::ref, 25, 25);
    EXPECT_DOUBLE_EQ(differences(reflectivity, level2::Moment::ref, 60, -10).between, 70);
}

TEST(CellCircles, APhaseGoesRoundIn360Degrees) {
    const auto volume = volume_of(level2::Moment::phi, 25, 25);
    EXPECT_DOUBLE_EQ(differences(volume, level2::Moment::phi, 359, 1).between, -2);
}

}  // namespace
}  // namespace stormcellar::grid
