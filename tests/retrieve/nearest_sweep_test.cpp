#include "retrieve/sweeps/nearest_sweep.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace stormcellar::retrieve {
namespace {

using level2::Moment;
using ::testing::ElementsAre;
using ::testing::Optional;

level2::Sweep sweep_at(float elevation_deg, std::vector<Moment> moments, int radials = 360) {
    level2::Sweep sweep;
    for (int i = 0; i < radials; ++i) {
        level2::Radial& radial = sweep.radials.emplace_back();
        radial.azimuth_deg = static_cast<float>(i) * 360 / static_cast<float>(radials);
        radial.elevation_deg = elevation_deg;
    }
    for (const Moment moment : moments)
        sweep.moments.emplace_back().moment = moment;
    return sweep;
}

TEST(NearestSweep, ACompanionIsTheSweepItselfElseTheNearestInElevationThenInOrder) {
    level2::Volume volume;
    volume.sweeps = {sweep_at(0.5F, {Moment::ref}), sweep_at(0.52F, {Moment::vel}),
                     sweep_at(0.9F, {Moment::ref}), sweep_at(0.91F, {Moment::vel}),
                     sweep_at(0.5F, {Moment::vel, Moment::ref})};
    EXPECT_THAT(companion_sweep(volume, 0, 0.5, Moment::vel), Optional(1U));
    EXPECT_THAT(companion_sweep(volume, 2, 0.9, Moment::vel), Optional(3U));
    EXPECT_THAT(companion_sweep(volume, 4, 0.5, Moment::vel), Optional(4U));
    EXPECT_THAT(companion_sweep(volume, 3, 0.91, Moment::ref), Optional(2U));
    EXPECT_EQ(companion_sweep(volume, 0, 0.5, Moment::rho), std::nullopt);
    EXPECT_EQ(companion_sweep(volume, 0, 5, Moment::vel), std::nullopt);
}

TEST(NearestSweep, TheSweepAboveIsTheNextElevationWithMostRadials) {
    level2::Volume volume;
    volume.sweeps = {sweep_at(0.5F, {Moment::ref}),       sweep_at(0.6F, {Moment::ref}),
                     sweep_at(1.45F, {Moment::ref}, 360), sweep_at(1.5F, {Moment::ref}, 720),
                     sweep_at(2.5F, {Moment::ref}, 720),  sweep_at(1, {Moment::vel})};
    for (level2::Sweep& sweep : volume.sweeps)
        sweep.moments.front().gate_stride = 10;
    EXPECT_THAT(sweep_above(volume, 0), Optional(3U));
    EXPECT_THAT(sweep_above(volume, 3), Optional(4U));
    EXPECT_EQ(sweep_above(volume, 4), std::nullopt);
}

TEST(NearestSweep, RadialsAreNearestAcrossNorthAndAbsentInGaps) {
    level2::Sweep sweep = sweep_at(0.5F, {Moment::ref});
    sweep.radials.resize(100);  // a gap from 100 degrees on
    const std::vector<float> azimuths = {0.2F, 50.6F, 99.9F, 104, 359.9F, 200};
    EXPECT_THAT(nearest_radials(azimuths, sweep), ElementsAre(0, 50, 99, -1, 0, -1));
    const std::vector<float> bad = {-1, 400};
    EXPECT_THAT(nearest_radials(bad, sweep), ElementsAre(-1, -1));
}

}  // namespace
}  // namespace stormcellar::retrieve
