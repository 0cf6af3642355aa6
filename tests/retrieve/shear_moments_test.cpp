// Tests the moments AZSH and DIVG: their flags, their codes against sweep_shear(), a vortex whose
// shear is known, and the tornado of Moore.
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "stormcellar/grid/site_frame.h"
#include "stormcellar/level2/decode.h"
#include "stormcellar/retrieve/derived_moments.h"
#include "stormcellar/retrieve/velocity_shear.h"
#include "tests/retrieve/rankine_vortex.h"
#include "tests/testing/data.h"

namespace stormcellar::retrieve {
namespace {

using level2::GateStatus;
using level2::Moment;
using level2::SweepMoment;

constexpr std::array both = {Moment::azsh, Moment::divg};
constexpr double unit_per_s = 0.001, half_step_per_s = 5e-6;

// Wind from the west at 20 m/s that spreads, with 1 m/s of noise.
FoldedVolume spreading_wind() {
    FoldedSpec spec;
    spec.nyquist_mps = 30;
    return fold(spec, [](double azimuth_deg, double range_m, double, double) {
        return 20 * std::sin(azimuth_deg * degree) + 1e-4 * range_m;
    });
}

double per_s(const SweepMoment& moment, std::uint16_t code) {
    return static_cast<double>(moment.value_of(code)) * unit_per_s;
}

TEST(ShearMoments, KeepTheFlagsOfVelocitiesAndAmbiguousGates) {
    level2::Volume volume = spreading_wind().volume;
    volume.sweeps[0].moments[0].codes8[5] = 0;
    volume.sweeps[0].moments[0].codes8[6] = 1;
    volume.sweeps[0].radials[7].nyquist_mps = 0;
    ASSERT_TRUE(add_derived_moments(volume, both));
    int values = 0, ambiguous = 0;
    for (const level2::Sweep& sweep : volume.sweeps) {
        const SweepMoment& measured = *sweep.find(Moment::vel);
        const SweepMoment& dealiased = *sweep.find(Moment::veld);
        for (const Moment moment : both) {
            const SweepMoment* shear = sweep.find(moment);
            ASSERT_NE(shear, nullptr);
            EXPECT_EQ(shear->gate_counts, measured.gate_counts);
            for (std::size_t radial = 0; radial < sweep.radials.size(); ++radial) {
                for (std::int32_t gate = 0; gate <= shear->gate_stride; ++gate) {
                    const GateStatus before = dealiased.status(radial, gate);
                    const GateStatus status = shear->status(radial, gate);
                    if (before == GateStatus::valid) {
                        ASSERT_TRUE(status == GateStatus::valid || status == GateStatus::ambiguous);
                    } else {
                        ASSERT_EQ(status, before) << "radial " << radial << ", gate " << gate;
                    }
                    values += status == GateStatus::valid ? 1 : 0;
                    ambiguous += status == GateStatus::ambiguous ? 1 : 0;
                }
            }
        }
    }
    EXPECT_EQ(volume.sweeps[0].find(Moment::azsh)->status(0, 5), GateStatus::below_threshold);
    EXPECT_EQ(volume.sweeps[0].find(Moment::azsh)->status(0, 6), GateStatus::range_folded);
    EXPECT_GT(values, 1'000'000);
    EXPECT_GT(ambiguous, 700) << "the radial without a Nyquist velocity";
}

TEST(ShearMoments, AreTheShearOfTheSweepWithinHalfAStep) {
    const level2::Volume measured = spreading_wind().volume;
    const Dealiased dealiased = dealias(measured, Dealiasing::automatic);
    const auto derived = derived_velocities(measured, both);
    ASSERT_TRUE(derived) << derived.error().message;
    for (const SweepFolds& folds : dealiased.sweeps) {
        const SweepShear shear = sweep_shear(measured, folds).value();
        const level2::Sweep& sweep = derived->volume.sweeps[folds.sweep];
        const SweepMoment& rotation = *sweep.find(Moment::azsh);
        const SweepMoment& divergence = *sweep.find(Moment::divg);
        int values = 0;
        for (std::size_t at = 0; at < shear.is_fitted.size(); ++at) {
            if (rotation.codes16[at] < 3) continue;
            ++values;
            ASSERT_EQ(shear.is_fitted[at], 1);
            ASSERT_NEAR(per_s(rotation, rotation.codes16[at]), shear.azimuthal_per_s[at],
                        half_step_per_s + 1e-8);
            ASSERT_NEAR(per_s(divergence, divergence.codes16[at]), shear.divergence_per_s[at],
                        half_step_per_s + 1e-8);
        }
        EXPECT_GT(values, 100'000);
    }
}

TEST(ShearMoments, AGateWithoutNeighborsIsAmbiguous) {
    FoldedSpec spec;
    spec.nyquist_mps = 30;
    spec.missing = 0;
    level2::Volume volume = fold(spec, [](double azimuth_deg, double range_m, double, double) {
                                const bool is_alone = std::abs(azimuth_deg - 90) < 0.9 &&
                                                      std::abs(range_m - 50e3) < 200;
                                return is_alone ? 5.0 : std::nan("");
                            }).volume;
    ASSERT_TRUE(add_derived_moments(volume, both));
    int alone = 0;
    for (const level2::Sweep& sweep : volume.sweeps)
        for (const Moment moment : both)
            for (const std::uint16_t code : sweep.find(moment)->codes16) {
                EXPECT_TRUE(code == 0 || code == 2) << code;
                alone += code == 2 ? 1 : 0;
            }
    EXPECT_GT(alone, 5);
}

TEST(ShearMoments, OfARankineVortexAreWithin5Percent) {
    for (const Vortex& vortex :
         {Vortex{20e3, 1000, 40, 33, 360, true}, Vortex{100e3, 4000, 25, 16, 720, true}}) {
        level2::Volume volume = fold(vortex).volume;
        ASSERT_TRUE(add_derived_moments(volume, both, {Dealiasing::anchored}));
        const SweepMoment& rotation = *volume.sweeps[0].find(Moment::azsh);
        const double in_the_middle = vortex.expected(Vortex::azimuth_deg, vortex.range_m);
        for_gates_around(vortex, static_cast<std::size_t>(rotation.gate_stride),
                         [&](std::size_t at, double expected) {
                             ASSERT_GE(rotation.codes16[at], 3);
                             EXPECT_NEAR(per_s(rotation, rotation.codes16[at]), expected,
                                         0.05 * in_the_middle);
                         });
    }
}

TEST(ShearMoments, FindTheTornadoOfMoore) {
    STORMCELLAR_NEED_DATA();
    const auto decoded = level2::decode_file(testing::real_file("volumes/KTLX19990503_235621.gz"));
    ASSERT_TRUE(decoded);
    const auto derived = derived_velocities(decoded->volume, both);
    ASSERT_TRUE(derived) << derived.error().message;
    const auto antenna = level2::antenna_position(decoded->volume).value();
    const grid::SiteFrame radar(antenna.latitude_deg, antenna.longitude_deg);
    const grid::SiteFrame tornado(35.25, -97.69);
    const level2::Sweep& sweep = *std::ranges::find_if(
        derived->volume.sweeps,
        [](const level2::Sweep& one) { return one.find(Moment::azsh) != nullptr; });
    const SweepMoment& rotation = *sweep.find(Moment::azsh);
    double greatest = 0;
    grid::GeoPoint place;
    for (std::size_t radial = 0; radial < sweep.radials.size(); ++radial) {
        for (std::int32_t gate = 0; gate < rotation.gate_counts[radial]; ++gate) {
            const std::uint16_t code = rotation.code(radial, gate);
            const double range_m = rotation.range_m(gate);
            // Close to the radar, the mean wind across the beam looks like shear.
            if (code < 3 || range_m < 5000 || per_s(rotation, code) <= greatest) continue;
            greatest = per_s(rotation, code);
            place = radar.to_geo({static_cast<double>(sweep.radials[radial].azimuth_deg), range_m});
        }
    }
    EXPECT_GT(greatest, 0.02);
    EXPECT_LT(tornado.to_polar(place).arc_m, 1500);
}

TEST(ShearMoments, NeedVelocitiesAndDealiasing) {
    EXPECT_EQ(derived_velocities({}, both).error().message, "the volume has no velocities");
    EXPECT_EQ(derived_velocities(spreading_wind().volume, both, {Dealiasing::off}).error().code,
              ErrorCode::bad_argument);
}

TEST(ShearMoments, AreReplacedAndLeftOutUnlessWanted) {
    level2::Volume volume = spreading_wind().volume;
    ASSERT_TRUE(add_derived_moments(volume, both));
    ASSERT_TRUE(add_derived_moments(volume, both));
    EXPECT_EQ(volume.sweeps[0].moments.size(), 4U);
    ASSERT_TRUE(add_derived_moments(volume, std::array{Moment::divg}));
    EXPECT_EQ(volume.sweeps[0].find(Moment::azsh), nullptr);
    EXPECT_NE(volume.sweeps[0].find(Moment::divg), nullptr);
}

}  // namespace
}  // namespace stormcellar::retrieve
