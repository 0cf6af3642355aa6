// Tests flags and values of the moments KDP and RATE.
#include "retrieve/derived/rain_moments.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "stormcellar/retrieve/derived_moments.h"
#include "stormcellar/retrieve/kdp.h"
#include "stormcellar/retrieve/rain_rate.h"
#include "tests/retrieve/phase_ramp.h"

namespace stormcellar::retrieve {
namespace {

using level2::GateStatus;
using level2::Moment;
using level2::SweepMoment;

// Returns a ramp of 2 degrees/km in echo of 45 dBZ.
level2::Volume rainy_volume() {
    level2::Volume volume = volume_of_ramp({[](double) { return 2.0; }, 1});
    SweepMoment echo = volume.sweeps[0].moments[1];
    echo.moment = Moment::ref;
    echo.scale = 2;
    echo.offset = 66;
    echo.codes8.assign(echo.codes8.size(), 156);  // 45 dBZ
    volume.sweeps[0].moments.push_back(echo);
    return volume;
}

constexpr std::array kdp_and_rate = {Moment::kdp, Moment::rate};

TEST(RainMoments, KdpHasTheFlagsOfPhaseAndTheFittedValues) {
    level2::Volume volume = rainy_volume();
    auto& phases = volume.sweeps[0].moments[0].codes16;
    phases[20] = 0;
    phases[21] = 1;
    volume.sweeps[0].moments[1].codes8[300] = 60;  // a low correlation amid good gates
    for (std::size_t at = 10 * ramp_gates; at < 11 * ramp_gates; ++at)
        volume.sweeps[0].moments[1].codes8[at] = 60;  // a radial of low correlation
    const auto fitted = specific_differential_phases(volume);
    ASSERT_TRUE(add_derived_moments(volume, kdp_and_rate));
    const SweepMoment* kdp = volume.sweeps[0].find(Moment::kdp);
    ASSERT_NE(kdp, nullptr);
    EXPECT_EQ(kdp->status(0, 20), GateStatus::below_threshold);
    EXPECT_EQ(kdp->status(0, 21), GateStatus::range_folded);
    EXPECT_EQ(kdp->status(0, 300), GateStatus::valid);
    EXPECT_EQ(kdp->status(10, 100), GateStatus::ambiguous);
    for (std::int32_t gate = 22; gate < ramp_gates; ++gate)
        EXPECT_NEAR(kdp->value_of(kdp->code(0, gate)),
                    fitted.at(0).deg_per_km[static_cast<std::size_t>(gate)], 0.0026F);
}

TEST(RainMoments, RateComesFromKdpOrElseFromReflectivity) {
    level2::Volume volume = rainy_volume();
    auto& echo = volume.sweeps[0].moments[2].codes8;
    echo[20] = 0;
    echo[21] = 1;
    echo[22] = 106;  // 20 dBZ
    ASSERT_TRUE(add_derived_moments(volume, kdp_and_rate));
    const SweepMoment* rate = volume.sweeps[0].find(Moment::rate);
    ASSERT_NE(rate, nullptr);
    EXPECT_EQ(rate->status(0, 20), GateStatus::below_threshold);
    EXPECT_EQ(rate->status(0, 21), GateStatus::range_folded);
    EXPECT_NEAR(rate->value_of(rate->code(0, 22)), rain_by_reflectivity_mm_per_h(20), 0.011);
    EXPECT_NEAR(rate->value_of(rate->code(0, 200)), rain_by_kdp_mm_per_h(2), 6);

    level2::Volume single = rainy_volume();
    single.sweeps[0].moments.erase(single.sweeps[0].moments.begin(),
                                   single.sweeps[0].moments.begin() + 2);
    ASSERT_TRUE(add_derived_moments(single, kdp_and_rate));
    const SweepMoment* by_echo = single.sweeps[0].find(Moment::rate);
    ASSERT_NE(by_echo, nullptr);
    EXPECT_NEAR(by_echo->value_of(by_echo->code(0, 200)), rain_by_reflectivity_mm_per_h(45), 0.011);
    EXPECT_EQ(single.sweeps[0].find(Moment::kdp), nullptr);
}

// A sweep without differential phase takes KDP from the other sweep of its angle.
TEST(RainMoments, ADopplerCutTakesKdpOfTheCutBelow) {
    level2::Volume volume = rainy_volume();
    volume.sweeps.push_back(volume.sweeps[0]);
    volume.sweeps[1].moments.erase(volume.sweeps[1].moments.begin(),
                                   volume.sweeps[1].moments.begin() + 2);
    ASSERT_TRUE(add_derived_moments(volume, std::array{Moment::rate}));
    const SweepMoment *here = volume.sweeps[0].find(Moment::rate),
                      *there = volume.sweeps[1].find(Moment::rate);
    ASSERT_NE(there, nullptr);
    EXPECT_EQ(here->codes16, there->codes16);
    EXPECT_EQ(volume.sweeps[0].find(Moment::kdp), nullptr) << "not wanted";
}

}  // namespace
}  // namespace stormcellar::retrieve
