// Runs every retrieval on volumes that break careless code. scripts/test runs these tests with
// floating-point traps (--traps) and under sanitizers (--asan-units).
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "base/floating_point.h"
#include "stormcellar/level2/decode.h"
#include "stormcellar/retrieve/cyclone.h"
#include "stormcellar/retrieve/derived_moments.h"
#include "stormcellar/retrieve/velocity_shear.h"
#include "stormcellar/retrieve/wind_profile.h"
#include "tests/retrieve/folded_volume.h"
#include "tests/testing/data.h"

namespace stormcellar::retrieve {
namespace {

using level2::GateStatus;
using level2::Moment;

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
constexpr float infinite = std::numeric_limits<float>::infinity();
constexpr auto all_rungs = std::to_array({Dealiasing::off, Dealiasing::profile, Dealiasing::region,
                                          Dealiasing::anchored, Dealiasing::automatic});
const synth::Wind steady{{{0, {18, 22}}}};
const synth::Wind strong{{{0, {55, 0}}}};

struct HardCase {
    std::string name;
    std::function<level2::Volume()> make;
};

// Gives the volume a position, without which find_cyclone() does not search.
level2::Volume placed(FoldedVolume folded) {
    folded.volume.block.emplace();
    folded.volume.block->latitude_deg = 30;
    folded.volume.block->longitude_deg = -90;
    return std::move(folded.volume);
}

FoldedSpec small_spec() {
    return {.nyquist_mps = 11, .elevations_deg = {0.5, 1.5, 4, 10}, .gates = 200};
}

template <class Change>
level2::Volume changed(const FoldedSpec& spec, Change change) {
    level2::Volume volume = placed(fold(spec, steady));
    for (level2::Sweep& sweep : volume.sweeps)
        change(sweep);
    return volume;
}

level2::Volume with_nyquist(float nyquist_mps) {
    return changed(small_spec(), [&](level2::Sweep& sweep) {
        for (level2::Radial& radial : sweep.radials)
            radial.nyquist_mps = nyquist_mps;
    });
}

level2::Volume with_radials(int radials) {
    FoldedSpec spec = small_spec();
    spec.radials = radials;
    // The last radials of legacy sweeps overlap the first.
    return changed(spec, [](level2::Sweep& sweep) {
        for (std::size_t i = 0; i < sweep.radials.size(); ++i)
            sweep.radials[i].azimuth_deg = std::fmod(static_cast<float>(i) + 0.25F, 360.0F);
    });
}

level2::Volume one_gate() {
    return placed(fold(one_gate_spec(), steady));
}

level2::Volume noise_alone() {
    FoldedSpec spec = small_spec();
    spec.speckle = 1;
    return placed(fold(spec, steady));
}

// Azimuths, radials and gates are missing.
level2::Volume gaps() {
    FoldedSpec spec = small_spec();
    spec.missing = 0.4;
    return changed(spec, [](level2::Sweep& sweep) {
        level2::SweepMoment& moment = sweep.moments[0];
        const auto stride = static_cast<std::size_t>(moment.gate_stride);
        for (std::size_t radial = 0; radial < sweep.radials.size(); ++radial) {
            if (radial % 7 == 0) moment.gate_counts[radial] = 0;
            if (radial % 11 == 0) moment.gate_counts[radial] = 30;
            for (std::size_t gate = 0; gate < stride; ++gate)
                if ((radial > 100 && radial < 210) || (gate > 50 && gate < 170))
                    moment.codes8[radial * stride + gate] = 0;
        }
        for (std::size_t radial = 300; radial < sweep.radials.size(); ++radial)
            sweep.radials[radial].azimuth_deg = 305;
    });
}

level2::Volume two_nyquists() {
    return changed(small_spec(), [](level2::Sweep& sweep) {
        for (std::size_t radial = 100; radial < 250; ++radial)
            sweep.radials[radial].nyquist_mps = 17;
    });
}

level2::Volume first_gate_behind() {
    return changed(small_spec(),
                   [](level2::Sweep& sweep) { sweep.moments[0].first_gate_m = -375; });
}

level2::Volume damaged_angles() {
    return changed(small_spec(), [](level2::Sweep& sweep) {
        sweep.radials[3].azimuth_deg = not_a_number;
        sweep.radials[50].azimuth_deg = infinite;
        sweep.radials[99].elevation_deg = not_a_number;
        sweep.radials[150].azimuth_deg = -1e30F;
        sweep.radials[151].elevation_deg = 1e6F;
        sweep.radials[152].nyquist_mps = not_a_number;
    });
}

level2::Volume no_echo() {
    FoldedSpec spec = small_spec();
    spec.missing = 1;
    return placed(fold(spec, steady));
}

level2::Volume all_folded() {
    FoldedSpec spec = small_spec();
    spec.nyquist_mps = 8;
    return placed(fold(spec, strong));
}

std::vector<HardCase> made_cases() {
    return {{"NyquistZero", [] { return with_nyquist(0); }},
            {"NyquistNotANumber", [] { return with_nyquist(not_a_number); }},
            {"NyquistInfinite", [] { return with_nyquist(infinite); }},
            {"NyquistNegative", [] { return with_nyquist(-11); }},
            {"NyquistTooHigh", [] { return with_nyquist(1e30F); }},
            {"NoSweeps", [] { return level2::Volume{}; }},
            {"NoEcho", no_echo},
            {"OneGate", one_gate},
            {"AllFolded", all_folded},
            {"NoiseAlone", noise_alone},
            {"Radials362", [] { return with_radials(362); }},
            {"Radials365", [] { return with_radials(365); }},
            {"Radials367", [] { return with_radials(367); }},
            {"Gaps", gaps},
            {"TwoNyquistVelocities", two_nyquists},
            {"FirstGateBehindTheRadar", first_gate_behind},
            {"DamagedAngles", damaged_angles}};
}

// Real volumes with these cases: a TDWR without Nyquist velocity, legacy sweeps of 362 to 367
// radials whose first gate is at -375 m, gaps of 100 degrees, noisy clear air, and one gate spacing
// or Nyquist velocity that differs from sweep to sweep.
std::vector<HardCase> real_cases() {
    std::vector<HardCase> cases;
    for (const auto& [name, file] : std::to_array<std::pair<const char*, const char*>>(
             {{"RealTerminalRadar", "Level2_TSTL_20220213_2357.ar2v"},
              {"RealLegacyRadials", "KOKX20080109_141449.gz"},
              {"RealFirstGateBehindTheRadar", "KTLX19910720_160529.gz"},
              {"RealAzimuthGaps", "KATX20160427_095248_V06.gz"},
              {"RealClearAir", "KLOT20220317_000842_V06"},
              {"RealLowNyquist", "KCCX20130112_070503_V06.gz"},
              {"RealDamage", "KMPX20060106_184002.gz"},
              {"RealNoRadials", "KFDR20160420_214957_V06.gz"}})) {
        cases.push_back({name, [path = std::string("volumes/") + file] {
                             return level2::decode_file(testing::real_file(path)).value().volume;
                         }});
    }
    return cases;
}

std::size_t velocities_in(const level2::Volume& volume) {
    std::size_t gates = 0;
    for (const level2::Sweep& sweep : volume.sweeps)
        for (const level2::SweepMoment& moment : sweep.moments)
            for (std::size_t radial = 0; radial < sweep.radials.size(); ++radial)
                for (std::int32_t gate = 0; gate < moment.gate_counts[radial]; ++gate)
                    gates += moment.moment == Moment::vel &&
                             moment.status(radial, gate) == GateStatus::valid;
    return gates;
}

// Expects a fold number of each gate, and 0 with a mark where the radial cannot be unfolded.
void expect_sound_folds(const level2::Volume& volume, const Dealiased& found) {
    EXPECT_LE(found.folded_gates, found.gates);
    EXPECT_LE(found.ambiguous_gates, found.gates);
    EXPECT_LE(static_cast<std::size_t>(found.gates), velocities_in(volume));
    for (const SweepFolds& folds : found.sweeps) {
        const level2::Sweep& sweep = volume.sweeps[folds.sweep];
        const auto stride = static_cast<std::size_t>(sweep.moments[folds.moment].gate_stride);
        ASSERT_EQ(folds.folds.size(), sweep.radials.size() * stride);
        ASSERT_EQ(folds.ambiguous.size(), folds.folds.size());
        for (std::size_t i = 0; i < folds.folds.size(); ++i) {
            const level2::Radial& radial = sweep.radials[i / stride];
            if (is_within(radial.nyquist_mps, 1.0F, 200.0F)) continue;
            ASSERT_EQ(folds.folds[i], 0);
        }
    }
}

void expect_sound_profile(const level2::Volume& volume, const Dealiased& found) {
    const auto layers = wind_profile(volume, found);
    ASSERT_TRUE(layers) << layers.error().message;
    EXPECT_EQ(layers->size(), 60U);
    for (const WindLayer& layer : *layers) {
        if (!layer.wind) {
            EXPECT_NE(text_of(layer.wind.error()), "unknown");
            continue;
        }
        EXPECT_TRUE(is_within(layer.wind->motion.speed_mps(), 0.0, 120.0));
        EXPECT_TRUE(is_within(layer.wind->u_error_mps, 0.0, 20.0));
        EXPECT_TRUE(is_within(layer.wind->v_error_mps, 0.0, 20.0));
        EXPECT_TRUE(is_within(layer.wind->rms_mps, 0.0, 60.0));
    }
    if (const auto motions = bunkers_motions(*layers)) {
        EXPECT_TRUE(is_within(motions->right.speed_mps(), 0.0, 150.0));
    } else {
        EXPECT_FALSE(motions.error().message.empty());
    }
}

void expect_sound_shear(const level2::Volume& volume, const Dealiased& found) {
    constexpr auto bounds = std::to_array({low_level, mid_level});
    const auto layers = shear_layers(volume, found, bounds);
    ASSERT_TRUE(layers) << layers.error().message;
    for (const ShearLayer& layer : *layers) {
        for (const ShearCell& cell : layer.cells) {
            ASSERT_TRUE(std::isfinite(cell.azimuthal_per_s));
            ASSERT_TRUE(is_within(cell.error_per_s, 0.0F, 1.0F));
        }
        EXPECT_LE(strongest_maxima(layer, {35, -97}).size(), MaximaOptions{}.most);
    }
}

void expect_sound_cyclone(const level2::Volume& volume, const Dealiased& found) {
    if (const auto cyclone = find_cyclone(volume, found)) {
        ADD_FAILURE() << "no hurricane: " << cyclone->maximum().tangential_mps.value << " m/s";
    } else {
        EXPECT_FALSE(cyclone.error().text.empty());
    }
}

void expect_sound_values(const level2::SweepMoment& moment, std::size_t radials) {
    for (std::size_t radial = 0; radial < radials; ++radial) {
        for (std::int32_t gate = 0; gate < moment.gate_counts[radial]; ++gate) {
            if (moment.status(radial, gate) != GateStatus::valid) continue;
            ASSERT_TRUE(is_within(moment.value_of(moment.code(radial, gate)), -400.0F, 400.0F));
        }
    }
}

// Expects VELD and SRV, or the reason why they are missing.
void expect_sound_moments(const level2::Volume& given, Dealiasing rung) {
    for (const MotionRule rule : {MotionRule::given, MotionRule::right}) {
        level2::Volume volume = given;
        DerivedOptions options;
        options.dealiasing = rung;
        options.motion = {rule, {10, 5}};
        const auto made =
            add_derived_moments(volume, std::array{Moment::veld, Moment::srv}, options);
        if (!made) {
            EXPECT_FALSE(made.error().message.empty());
            continue;
        }
        for (const level2::Sweep& sweep : volume.sweeps) {
            if (const level2::SweepMoment* srv = sweep.find(Moment::srv))
                expect_sound_values(*srv, sweep.radials.size());
        }
    }
}

void expect_sound_retrievals(const level2::Volume& volume) {
    const bool is_needed = needs_dealiasing(volume);
    for (const Dealiasing rung : all_rungs) {
        SCOPED_TRACE(dealiasing_name(rung));
        const Dealiased found = dealias(volume, rung);
        const Dealiasing needed = is_needed ? Dealiasing::anchored : Dealiasing::off;
        EXPECT_EQ(found.rung, rung == Dealiasing::automatic ? needed : rung);
        expect_sound_folds(volume, found);
        expect_sound_profile(volume, found);
        expect_sound_shear(volume, found);
        expect_sound_moments(volume, rung);
        if (rung == Dealiasing::anchored) expect_sound_cyclone(volume, found);
    }
}

class HardVelocities : public ::testing::TestWithParam<HardCase> {};
TEST_P(HardVelocities, AreNoTroubleForAnyRetrieval) {
    expect_sound_retrievals(GetParam().make());
}
constexpr auto name_of_case = [](const ::testing::TestParamInfo<HardCase>& info) {
    return info.param.name;
};
INSTANTIATE_TEST_SUITE_P(Made, HardVelocities, ::testing::ValuesIn(made_cases()), name_of_case);

class RealHardVelocities : public ::testing::TestWithParam<HardCase> {};
TEST_P(RealHardVelocities, AreNoTroubleForAnyRetrieval) {
    STORMCELLAR_NEED_DATA();
    expect_sound_retrievals(GetParam().make());
}
INSTANTIATE_TEST_SUITE_P(Real, RealHardVelocities, ::testing::ValuesIn(real_cases()), name_of_case);

// The radar of wind `strong` sees nearly no gate below its Nyquist velocity.
TEST(HardWinds, AllFoldedIsUnfolded) {
    FoldedSpec spec = small_spec();
    spec.nyquist_mps = 8;
    const FoldedVolume folded = fold(spec, strong);
    const Dealiased found = dealias(folded.volume, Dealiasing::anchored);
    EXPECT_GT(found.folded_gates, found.gates * 4 / 5);
    EXPECT_LE(score(folded, found).wrong_share(), 0.001);
}

// Each part of a sweep is unfolded with its own Nyquist velocity.
TEST(HardWinds, TwoNyquistVelocitiesHaveTheirOwnTurns) {
    FoldedSpec low = small_spec(), high = small_spec();
    high.nyquist_mps = 17;
    FoldedVolume mixed = fold(low, steady);
    const FoldedVolume other = fold(high, steady);
    for (std::size_t s = 0; s < mixed.volume.sweeps.size(); ++s) {
        level2::Sweep& sweep = mixed.volume.sweeps[s];
        const level2::Sweep& from = other.volume.sweeps[s];
        for (std::size_t radial = 100; radial < 250; ++radial) {
            sweep.radials[radial] = from.radials[radial];
            for (std::size_t i = radial * 200; i < (radial + 1) * 200; ++i) {
                sweep.moments[0].codes8[i] = from.moments[0].codes8[i];
                mixed.folds[s][i] = other.folds[s][i];
                mixed.true_mps[s][i] = other.true_mps[s][i];
            }
        }
    }
    EXPECT_LE(score(mixed, dealias(mixed.volume, Dealiasing::anchored)).wrong_share(), 0.001);
}

}  // namespace
}  // namespace stormcellar::retrieve
