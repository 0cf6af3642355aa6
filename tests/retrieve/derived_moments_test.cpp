// Tests the storm-relative velocity with winds and motions that are known, its flags, and volumes
// that give no motion.
#include "stormcellar/retrieve/derived_moments.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "base/degree.h"
#include "stormcellar/level2/decode.h"
#include "tests/retrieve/folded_volume.h"
#include "tests/testing/data.h"

namespace stormcellar::retrieve {
namespace {

using level2::Moment;
using level2::SweepMoment;

constexpr std::array srv_alone = {Moment::srv};
constexpr double step_mps = 0.01;          // of VELD and SRV
constexpr double received_step_mps = 0.5;  // of the velocities that FoldedVolume makes

FoldedSpec quiet_air(double nyquist_mps) {
    FoldedSpec spec;
    spec.nyquist_mps = nyquist_mps;
    spec.elevations_deg = {0.5, 2.5, 5, 10, 19.5};
    spec.gates = 140;  // 2 to 37 km
    spec.noise_mps = 0;
    return spec;
}

// Returns the velocities of a wind that is linear in height, from `low` at the antenna to `high` at
// 8 km, up to the height `top_m`.
RadialVelocity wind_between(const Motion& low, const Motion& high, double top_m = 1e6) {
    return [=](double azimuth_deg, double /*range_m*/, double elevation_deg, double height_m) {
        if (height_m > top_m) return std::nan("");
        const double part = height_m / 8000;
        const double u = low.u_mps + part * (high.u_mps - low.u_mps);
        const double v = low.v_mps + part * (high.v_mps - low.v_mps);
        return (u * std::sin(azimuth_deg * degree) + v * std::cos(azimuth_deg * degree)) *
               std::cos(elevation_deg * degree);
    };
}

RadialVelocity in_uniform_wind(const Motion& wind) {
    return wind_between(wind, wind);
}

DerivedOptions given(const char* motion) {
    return {Dealiasing::anchored, motion_choice_from(motion).value()};
}

// Calls visit(radial, code of VELD, code of SRV, moment) for all gates.
template <class Visit>
void for_each_gate(const level2::Volume& volume, Visit visit) {
    for (const level2::Sweep& sweep : volume.sweeps) {
        const SweepMoment* dealiased = sweep.find(Moment::veld);
        const SweepMoment* relative = sweep.find(Moment::srv);
        ASSERT_NE(dealiased, nullptr);
        ASSERT_NE(relative, nullptr);
        ASSERT_EQ(relative->codes16.size(), dealiased->codes16.size());
        for (std::size_t radial = 0; radial < sweep.radials.size(); ++radial)
            for (std::int32_t gate = 0; gate < dealiased->gate_counts[radial]; ++gate)
                visit(sweep.radials[radial], dealiased->code(radial, gate),
                      relative->code(radial, gate), *relative);
    }
}

TEST(StormRelativeVelocity, IsZeroIfTheAirMovesWithTheStorm) {
    const Motion wind = parse_motion("240/20").value();
    for (const double nyquist : {12.0, 30.0}) {
        level2::Volume volume = fold(quiet_air(nyquist), in_uniform_wind(wind)).volume;
        const auto derived = add_derived_moments(volume, srv_alone, given("240/20"));
        ASSERT_TRUE(derived) << derived.error().message;
        int gates = 0;
        double greatest = 0;
        for_each_gate(volume, [&](const level2::Radial&, std::uint16_t, std::uint16_t code,
                                  const SweepMoment& relative) {
            if (code < 3) return;
            ++gates;
            greatest = std::max(greatest, std::abs(static_cast<double>(relative.value_of(code))));
        });
        EXPECT_GT(gates, 200'000);
        EXPECT_LE(greatest, received_step_mps / 2 + step_mps) << "Nyquist velocity " << nyquist;
    }
}

TEST(StormRelativeVelocity, LosesThePartOfTheMotionAlongTheBeam) {
    level2::Volume volume = fold(quiet_air(30), in_uniform_wind({3, -4})).volume;
    // A storm that moves toward the east at 10 m/s.
    ASSERT_TRUE(add_derived_moments(volume, srv_alone, given("270/10")));
    for_each_gate(volume, [](const level2::Radial& radial, std::uint16_t dealiased,
                             std::uint16_t code, const SweepMoment& relative) {
        if (dealiased < 3) {
            ASSERT_EQ(code, dealiased);
            return;
        }
        const double change = static_cast<double>(relative.value_of(code)) -
                              static_cast<double>(relative.value_of(dealiased));
        const double azimuth = static_cast<double>(radial.azimuth_deg) * degree;
        const double elevation = static_cast<double>(radial.elevation_deg) * degree;
        ASSERT_NEAR(change, -10 * std::sin(azimuth) * std::cos(elevation), step_mps);
    });
}

TEST(StormRelativeVelocity, KeepsFlagsAndAmbiguousGates) {
    level2::Volume volume = fold(quiet_air(30), in_uniform_wind({3, -4})).volume;
    level2::Sweep& sweep = volume.sweeps.front();
    sweep.moments[0].codes8[5] = 0;
    sweep.moments[0].codes8[6] = 1;
    sweep.radials[7].nyquist_mps = 0;
    ASSERT_TRUE(add_derived_moments(volume, srv_alone, given("270/10")));
    const SweepMoment& relative = *volume.sweeps.front().find(Moment::srv);
    EXPECT_EQ(relative.status(0, 5), level2::GateStatus::below_threshold);
    EXPECT_EQ(relative.status(0, 6), level2::GateStatus::range_folded);
    int ambiguous = 0;
    for_each_gate(volume, [&](const level2::Radial&, std::uint16_t dealiased, std::uint16_t code,
                              const SweepMoment&) {
        EXPECT_EQ(code == 2, dealiased == 2);
        ambiguous += code == 2 ? 1 : 0;
    });
    EXPECT_GT(ambiguous, 100) << "the radial without a Nyquist velocity";
}

TEST(StormRelativeVelocity, TakesTheMotionFromTheWindProfile) {
    const level2::Volume measured = fold(quiet_air(15), wind_between({2, 10}, {34, 10})).volume;
    const auto layers = wind_profile(measured, dealias(measured, Dealiasing::anchored));
    ASSERT_TRUE(layers);
    const auto motions = bunkers_motions(*layers);
    ASSERT_TRUE(motions) << motions.error().message;
    // The shear points to the east, so the right mover is slower toward the north.
    EXPECT_NEAR(motions->mean.u_mps, 14, 0.5);
    EXPECT_NEAR(motions->right.v_mps, 2.5, 0.5);
    for (const auto& [word, motion] :
         {std::pair{"auto", motions->right}, std::pair{"right", motions->right},
          std::pair{"left", motions->left}, std::pair{"mean", motions->mean}}) {
        const auto derived = derived_velocities(measured, srv_alone, given(word));
        ASSERT_TRUE(derived) << derived.error().message;
        const auto used = motion_in_notes(derived->notes);
        ASSERT_TRUE(used) << word;
        EXPECT_EQ(format_motion(*used), format_motion(motion)) << word;
        for_each_gate(derived->volume, [&](const level2::Radial& radial, std::uint16_t dealiased,
                                           std::uint16_t code, const SweepMoment& relative) {
            if (dealiased < 3) return;
            const double expected =
                storm_relative_mps(static_cast<double>(relative.value_of(dealiased)),
                                   static_cast<double>(radial.azimuth_deg),
                                   static_cast<double>(radial.elevation_deg), *used);
            ASSERT_NEAR(static_cast<double>(relative.value_of(code)), expected, step_mps);
        });
    }
}

// The fold numbers, which the wind profile needs, are read back from VELD.
TEST(StormRelativeVelocity, ComesAlsoFromSweepsThatWereDealiasedBefore) {
    level2::Volume at_once = fold(quiet_air(15), wind_between({2, 10}, {34, 10})).volume;
    level2::Volume later = at_once;
    for (level2::Sweep& sweep : later.sweeps)
        sweep = dealiased_sweep(sweep, Dealiasing::anchored, {});
    ASSERT_EQ(later.sweeps.front().moments.size(), 2U);
    const auto derived = add_derived_moments(at_once, srv_alone, given("right"));
    const auto notes = add_from_dealiased(later, Moment::srv, given("right"));
    ASSERT_TRUE(derived && notes);
    EXPECT_EQ(*notes, derived->notes);
    for (std::size_t i = 0; i < later.sweeps.size(); ++i)
        EXPECT_EQ(later.sweeps[i].find(Moment::srv)->codes16,
                  at_once.sweeps[i].find(Moment::srv)->codes16);
    level2::Volume without = fold(quiet_air(15), in_uniform_wind({3, 4})).volume;
    EXPECT_FALSE(add_from_dealiased(without, Moment::srv, given("right")))
        << "without VELD there is no wind";
}

// The tornado of Moore moved toward the radar, so its velocities were -49 and +23 m/s. Seen from
// the storm, both sides of the vortex are about equally strong.
TEST(StormRelativeVelocity, BalancesTheTornadoOfMoore) {
    STORMCELLAR_NEED_DATA();
    const auto decoded = level2::decode_file(testing::real_file("volumes/KTLX19990503_235621.gz"));
    ASSERT_TRUE(decoded);
    const auto derived = derived_velocities(decoded->volume, srv_alone);
    ASSERT_TRUE(derived) << derived.error().message;
    const auto sweep = std::ranges::find_if(derived->volume.sweeps, [](const level2::Sweep& one) {
        return one.find(Moment::srv) != nullptr;
    });
    ASSERT_NE(sweep, derived->volume.sweeps.end());
    const SweepMoment& relative = *sweep->find(Moment::srv);
    double least = 0, greatest = 0;
    for (std::size_t radial = 0; radial < sweep->radials.size(); ++radial) {
        if (std::abs(sweep->radials[radial].azimuth_deg - 254.5F) > 4) continue;
        for (std::int32_t gate = 0; gate < relative.gate_counts[radial]; ++gate) {
            const int range_m = relative.first_gate_m + gate * relative.gate_spacing_m;
            const std::uint16_t code = relative.code(radial, gate);
            if (std::abs(range_m - 38'500) > 2500 || code < 3) continue;
            least = std::min(least, static_cast<double>(relative.value_of(code)));
            greatest = std::max(greatest, static_cast<double>(relative.value_of(code)));
        }
    }
    EXPECT_LT(least, -33);
    EXPECT_GT(greatest, 33);
    EXPECT_NEAR(least + greatest, 0, 3);
}

TEST(StormRelativeVelocity, SaysWhyThereIsNoMotion) {
    const auto shallow = fold(quiet_air(15), wind_between({2, 10}, {34, 10}, 3000));
    const auto refused = derived_velocities(shallow.volume, srv_alone);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::not_found);
    EXPECT_NE(refused.error().message.find("gives no storm motion: the highest wind is "),
              std::string::npos)
        << refused.error().message;
    EXPECT_TRUE(derived_velocities(shallow.volume, srv_alone, given("240/15")))
        << "a given motion needs no profile";
    EXPECT_TRUE(derived_velocities(shallow.volume, std::array{Moment::veld}));

    FoldedSpec silent = quiet_air(15);
    silent.missing = 1;
    const auto nothing =
        derived_velocities(fold(silent, in_uniform_wind({3, 4})).volume, srv_alone);
    ASSERT_FALSE(nothing);
    EXPECT_NE(nothing.error().message.find("no layer has a wind"), std::string::npos);
    EXPECT_EQ(derived_velocities({}, srv_alone).error().message, "the volume has no velocities");
    EXPECT_EQ(derived_velocities(shallow.volume, srv_alone, {Dealiasing::off}).error().code,
              ErrorCode::bad_argument);
}

TEST(StormRelativeVelocity, IsReplacedAndLeftOutUnlessWanted) {
    level2::Volume volume = fold(quiet_air(30), in_uniform_wind({3, -4})).volume;
    ASSERT_TRUE(add_derived_moments(volume, srv_alone, given("270/10")));
    ASSERT_TRUE(add_derived_moments(volume, srv_alone, given("180/10")));
    EXPECT_EQ(volume.sweeps.front().moments.size(), 3U);
    const auto derived = add_derived_moments(volume, std::array{Moment::veld}, given("270/10"));
    ASSERT_TRUE(derived);
    EXPECT_TRUE(derived->notes.empty());
    EXPECT_EQ(volume.sweeps.front().find(Moment::srv), nullptr);
}

TEST(MotionChoice, IsAWordOrAMotion) {
    EXPECT_EQ(motion_choice_from("auto")->rule, MotionRule::right);
    EXPECT_EQ(motion_choice_from("left")->rule, MotionRule::left);
    const auto north = motion_choice_from("180/12.5");
    ASSERT_TRUE(north);
    EXPECT_EQ(north->rule, MotionRule::given);
    EXPECT_NEAR(north->motion.v_mps, 12.5, 1e-12);
    for (const char* bad : {"", "Auto", "fast", "240", "240/-1", "400/5", "240/15/3"}) {
        const auto refused = motion_choice_from(bad);
        ASSERT_FALSE(refused) << bad;
        EXPECT_EQ(refused.error().code, ErrorCode::bad_argument);
        EXPECT_NE(refused.error().message.find(motion_choices()), std::string::npos);
    }
}

TEST(MotionChoice, IsReadBackFromItsTextAndFoundInNotes) {
    const auto fits = [](const std::string& note, const char* choice) {
        return is_of_motion(std::array{std::string("a note"), note}, *motion_choice_from(choice));
    };
    for (const char* text : {"right", "left", "mean", "240/15.5"})
        EXPECT_EQ(motion_choice_text(*motion_choice_from(text)), text);
    EXPECT_TRUE(fits("storm motion 240/15, as given", "240/15"));
    EXPECT_TRUE(fits("KTLX: storm motion 240/15, as given", "240.2/15"));
    EXPECT_FALSE(fits("storm motion 240/15, as given", "240/1"));
    EXPECT_FALSE(fits("storm motion 240/15, as given", "auto"));
    EXPECT_TRUE(fits("storm motion 240/15, right mover of the wind profile", "auto"));
    EXPECT_FALSE(fits("storm motion 240/15, right mover of the wind profile", "240/15"));
    EXPECT_FALSE(fits("storm motion 240/15, right mover of the wind profile", "left"));
    EXPECT_TRUE(fits("no motion", "240/15"));
}

TEST(MotionInNotes, IsNoneIfSitesDiffer) {
    const auto found = [](std::vector<std::string> notes) {
        const auto motion = motion_in_notes(notes);
        return motion ? format_motion(*motion) : std::string{};
    };
    EXPECT_EQ(found({"a note", "storm motion 240/15.5, as given"}), "240/15.5");
    EXPECT_EQ(found({"KTLX: storm motion 240/15, as given", "KFDR: storm motion 240/15, as given"}),
              "240/15");
    EXPECT_EQ(found({"KTLX: storm motion 240/15, as given", "KFDR: storm motion 250/15, as given"}),
              "");
    EXPECT_EQ(found({"a storm motion 240/15, as given", "storm motion fast, unknown"}), "");
    EXPECT_EQ(found({}), "");
}

}  // namespace
}  // namespace stormcellar::retrieve
