// Tests that the moment VELD is VEL plus whole turns of the Nyquist circle, and nothing else.
#include <algorithm>
#include <array>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "level2/decode/volume_checks.h"
#include "stormcellar/level2/decode.h"
#include "stormcellar/retrieve/dealias.h"
#include "stormcellar/retrieve/derived_moments.h"
#include "tests/retrieve/folded_volume.h"
#include "tests/testing/data.h"

namespace stormcellar::retrieve {
namespace {

using level2::GateStatus;
using level2::Moment;
using level2::SweepMoment;

constexpr float accuracy_mps = 0.006F;  // half a step of VELD, and the rounding of floats
constexpr std::uint16_t ambiguous_code = 2;
constexpr auto every_rung = std::to_array({Dealiasing::off, Dealiasing::profile, Dealiasing::region,
                                           Dealiasing::anchored, Dealiasing::automatic});

std::vector<const SweepMoment*> moments_of(const level2::Sweep& sweep, Moment moment) {
    std::vector<const SweepMoment*> found;
    for (const SweepMoment& kind : sweep.moments)
        if (kind.moment == moment) found.push_back(&kind);
    return found;
}

struct Counts {
    int values = 0, flags = 0, folded = 0, ambiguous = 0;
};

void compare_gate(const SweepMoment& raw, const SweepMoment& made, std::size_t radial,
                  std::int32_t gate, float nyquist_mps, Counts& counts) {
    const std::uint16_t code = made.code(radial, gate);
    if (raw.status(radial, gate) != GateStatus::valid) {
        ++counts.flags;
        ASSERT_EQ(code, raw.code(radial, gate)) << "flags are kept";
        return;
    }
    if (made.status(radial, gate) == GateStatus::ambiguous) {
        ++counts.ambiguous;
        ASSERT_EQ(code, ambiguous_code);
        return;
    }
    ASSERT_EQ(made.status(radial, gate), GateStatus::valid);
    ++counts.values;
    const float turned_mps = made.value_of(code) - raw.value_of(raw.code(radial, gate));
    const float turns = nyquist_mps > 0 ? std::round(turned_mps / (2 * nyquist_mps)) : 0;
    counts.folded += turns != 0 ? 1 : 0;
    ASSERT_NEAR(turned_mps, 2 * turns * nyquist_mps, accuracy_mps);
}

// Compares each gate of VELD with the gate of VEL. Expects the same rows.
Counts compare_gates(const level2::Volume& volume) {
    Counts counts;
    for (const level2::Sweep& sweep : volume.sweeps) {
        const auto raws = moments_of(sweep, Moment::vel), mades = moments_of(sweep, Moment::veld);
        EXPECT_EQ(raws.size(), mades.size());
        for (std::size_t i = 0; i < std::min(raws.size(), mades.size()); ++i) {
            const SweepMoment &raw = *raws[i], &made = *mades[i];
            EXPECT_EQ(made.first_gate_m, raw.first_gate_m);
            EXPECT_EQ(made.gate_spacing_m, raw.gate_spacing_m);
            EXPECT_EQ(made.gate_stride, raw.gate_stride);
            EXPECT_EQ(made.gate_counts, raw.gate_counts);
            EXPECT_EQ(made.word_size_bits, 16);
            for (std::size_t radial = 0; radial < sweep.radials.size(); ++radial)
                for (std::int32_t gate = 0; gate < raw.gate_counts[radial]; ++gate) {
                    compare_gate(raw, made, radial, gate, sweep.radials[radial].nyquist_mps,
                                 counts);
                    if (::testing::Test::HasFatalFailure()) return counts;
                }
        }
    }
    return counts;
}

level2::Volume volume_in(const char* name) {
    return level2::decode_file(testing::real_file(name)).value().volume;
}

// Returns a volume in which nothing is folded.
level2::Volume calm_volume() {
    FoldedSpec spec{.nyquist_mps = 26, .elevations_deg = {0.5, 1.5}, .gates = 100};
    return fold(spec, [](double azimuth_deg, double, double,
                         double) { return 8 * std::cos(azimuth_deg / 57.3); })
        .volume;
}

template <class Change>
void change_velocities(level2::Volume& volume, Change change) {
    for (level2::Sweep& sweep : volume.sweeps)
        for (SweepMoment& kind : sweep.moments)
            if (kind.moment == Moment::vel) change(sweep, kind);
}

TEST(DealiasedMoment, IsRawPlusWholeTurnsAtEveryGateOfRealVolumes) {
    STORMCELLAR_NEED_DATA();
    for (const char* file :
         {"volumes/KTLX19990503_235621.gz", "volumes/KCRP20170826_044114.trimmed.ar2v"}) {
        SCOPED_TRACE(file);
        const level2::Volume measured = volume_in(file);
        for (const Dealiasing rung : {Dealiasing::region, Dealiasing::anchored}) {
            level2::Volume volume = measured;
            const auto found = add_dealiased_velocity(volume, rung);
            ASSERT_TRUE(found) << found.error().message;
            const Counts counts = compare_gates(volume);
            EXPECT_GT(counts.values, 100'000);
            EXPECT_GT(counts.flags, 100'000);
            EXPECT_GT(counts.folded, 1000);
            EXPECT_GT(counts.ambiguous, 100);
            EXPECT_EQ(counts.values + counts.ambiguous, found->gates);
            EXPECT_EQ(counts.ambiguous, found->ambiguous_gates);
            EXPECT_LE(counts.folded, found->folded_gates)
                << "some of the folded gates are ambiguous";
            for (std::size_t i = 0; i < volume.sweeps.size(); ++i) {
                const auto before = moments_of(measured.sweeps[i], Moment::vel);
                const auto after = moments_of(volume.sweeps[i], Moment::vel);
                ASSERT_EQ(before.size(), after.size());
                for (std::size_t k = 0; k < before.size(); ++k) {
                    EXPECT_EQ(before[k]->codes8, after[k]->codes8) << "VEL stays as it was";
                    EXPECT_EQ(before[k]->codes16, after[k]->codes16);
                }
            }
        }
    }
}

TEST(DealiasedMoment, ASecondCallReplacesIt) {
    level2::Volume volume = fold({}, synth::Wind{}).volume;
    ASSERT_TRUE(add_dealiased_velocity(volume, Dealiasing::anchored));
    change_velocities(volume, [](const level2::Sweep&, SweepMoment& kind) {
        for (std::uint8_t& code : kind.codes8)
            code = code < 2 ? code : 131;  // 1 m/s
    });
    ASSERT_TRUE(add_dealiased_velocity(volume, Dealiasing::off));
    for (const level2::Sweep& sweep : volume.sweeps) {
        ASSERT_EQ(moments_of(sweep, Moment::veld).size(), 1U);
        for (const std::uint16_t code : sweep.find(Moment::veld)->codes16)
            if (code > 2) {
                ASSERT_NEAR(sweep.find(Moment::veld)->value_of(code), 1, accuracy_mps);
            }
    }
}

TEST(DealiasedMoment, WithOffHasTheRawVelocities) {
    STORMCELLAR_NEED_DATA();
    level2::Volume volume = volume_in("volumes/KTLX19990503_235621.gz");
    ASSERT_TRUE(add_dealiased_velocity(volume, Dealiasing::off));
    const Counts counts = compare_gates(volume);
    EXPECT_GT(counts.values, 100'000);
    EXPECT_EQ(counts.folded, 0);
    EXPECT_EQ(counts.ambiguous, 0);
}

TEST(DealiasedMoment, OfAVolumeWithoutVelocitiesIsNotFound) {
    level2::Volume measured = calm_volume();
    change_velocities(measured,
                      [](const level2::Sweep&, SweepMoment& kind) { kind.moment = Moment::ref; });
    for (level2::Volume volume : {measured, level2::Volume{}}) {
        for (const Dealiasing rung : every_rung) {
            const auto added = add_dealiased_velocity(volume, rung);
            ASSERT_FALSE(added);
            EXPECT_EQ(added.error().code, ErrorCode::not_found);
            EXPECT_EQ(added.error().message, "the volume has no velocities");
            // Without dealiasing, no derived moment is made, whatever the volume has.
            EXPECT_EQ(derived_velocities(volume, std::array{Moment::veld}, {rung, {}}).error().code,
                      rung == Dealiasing::off ? ErrorCode::bad_argument : ErrorCode::not_found);
            EXPECT_FALSE(level2::holds(volume, Moment::veld));
        }
    }
}

// On 2026-11-29, `automatic` gave the raw velocities of radials without a Nyquist velocity.
TEST(DealiasedMoment, WithoutANyquistVelocityIsAmbiguous) {
    const level2::Volume calm = calm_volume();
    for (const float nyquist_mps : {0.0F, -5.0F, std::nanf(""), 1e9F}) {
        for (const Dealiasing rung : every_rung) {
            if (rung == Dealiasing::off) continue;
            SCOPED_TRACE(dealiasing_name(rung));
            level2::Volume volume = calm;
            for (level2::Sweep& sweep : volume.sweeps)
                for (std::size_t radial = 40; radial < 100; ++radial)
                    sweep.radials[radial].nyquist_mps = nyquist_mps;
            ASSERT_TRUE(add_dealiased_velocity(volume, rung));
            int values = 0, others = 0;
            for (const level2::Sweep& sweep : volume.sweeps) {
                const SweepMoment &raw = *sweep.find(Moment::vel),
                                  &made = *sweep.find(Moment::veld);
                for (std::size_t radial = 0; radial < sweep.radials.size(); ++radial)
                    for (std::int32_t gate = 0; gate < made.gate_stride; ++gate) {
                        if (raw.status(radial, gate) != GateStatus::valid) continue;
                        const GateStatus status = made.status(radial, gate);
                        const bool is_known = radial < 40 || radial >= 100;
                        if (!is_known) {
                            ASSERT_EQ(status, GateStatus::ambiguous) << radial;
                        }
                        values += is_known && status == GateStatus::valid ? 1 : 0;
                        others += is_known && status != GateStatus::valid ? 1 : 0;
                    }
            }
            // Each sheet is one region here. `region` cannot know by how many turns such a region
            // is off.
            if (rung == Dealiasing::region) continue;
            EXPECT_GT(values, 50 * others) << "the other radials keep their velocities";
        }
    }
}

TEST(DealiasedMoment, OfATerminalRadarIsAmbiguousThroughout) {
    STORMCELLAR_NEED_DATA();
    level2::Volume volume = volume_in("volumes/Level2_TSTL_20220213_2357.ar2v");
    ASSERT_TRUE(add_dealiased_velocity(volume, Dealiasing::automatic));
    const Counts counts = compare_gates(volume);
    EXPECT_EQ(counts.values, 0);
    EXPECT_GT(counts.ambiguous, 100'000);
}

TEST(DealiasedMoment, FasterThanAnyWindIsAmbiguous) {
    level2::Volume volume = calm_volume();
    change_velocities(volume, [](const level2::Sweep&, SweepMoment& kind) {
        kind.scale = 1 / 8.0F;  // codes are 8 m/s, so that the largest velocity is 1,008 m/s
        for (std::size_t i = 0; i < kind.codes8.size(); ++i)
            kind.codes8[i] = static_cast<std::uint8_t>(i % 256);
    });
    ASSERT_TRUE(add_dealiased_velocity(volume, Dealiasing::off));
    for (const level2::Sweep& sweep : volume.sweeps) {
        const SweepMoment &raw = *sweep.find(Moment::vel), &made = *sweep.find(Moment::veld);
        for (std::int32_t gate = 0; gate < raw.gate_stride; ++gate) {
            if (raw.status(1, gate) != GateStatus::valid) continue;
            const float velocity = raw.value_of(raw.code(1, gate));
            const bool is_possible = std::abs(velocity) <= 320;
            ASSERT_EQ(made.status(1, gate),
                      is_possible ? GateStatus::valid : GateStatus::ambiguous);
            if (is_possible) {
                ASSERT_NEAR(made.value_of(made.code(1, gate)), velocity, accuracy_mps);
            }
        }
    }
}

TEST(NeedsDealiasing, TellsStormsFromCalmAir) {
    STORMCELLAR_NEED_DATA();
    EXPECT_TRUE(needs_dealiasing(volume_in("volumes/KTLX19990503_235621.gz")));
    EXPECT_TRUE(needs_dealiasing(volume_in("volumes/KCRP20170826_044114.trimmed.ar2v")));
    EXPECT_FALSE(needs_dealiasing(volume_in("sequence-kbgm/KBGM20050822_025001.gz")));
    EXPECT_FALSE(needs_dealiasing(calm_volume()));
    EXPECT_FALSE(needs_dealiasing({}));
    EXPECT_TRUE(needs_dealiasing(fold({}, [](double azimuth_deg, double, double, double) {
                                     return 20 * std::cos(azimuth_deg / 57.3);
                                 }).volume));
}

TEST(DealiasingName, ComesBackOrIsRefusedWithAllNames) {
    for (const Dealiasing rung : every_rung) {
        const auto back = dealiasing_from_name(dealiasing_name(rung));
        ASSERT_TRUE(back);
        EXPECT_EQ(*back, rung);
        EXPECT_THAT(dealiasing_names(), ::testing::HasSubstr(std::string(dealiasing_name(rung))));
    }
    for (const char* name : {"", "Auto", "anchor", "automatic"}) {
        const auto refused = dealiasing_from_name(name);
        ASSERT_FALSE(refused) << name;
        EXPECT_EQ(refused.error().code, ErrorCode::bad_argument);
    }
    EXPECT_EQ(dealiasing_from_name("uw").error().message,
              "'uw' is no way to dealias; it must be off, auto, profile, region or anchored");
}

TEST(DealiasedVelocities, HasOnlyVelocitiesAndTheSameRadials) {
    STORMCELLAR_NEED_DATA();
    const level2::Volume measured = volume_in("volumes/KTLX19990503_235621.gz");
    const auto derived =
        derived_velocities(measured, std::array{Moment::veld}, {Dealiasing::region, {}});
    ASSERT_TRUE(derived) << derived.error().message;
    const level2::Volume* const made = &derived->volume;
    EXPECT_EQ(made->station, measured.station);
    EXPECT_EQ(made->vcp, measured.vcp);
    EXPECT_EQ(made->start_time(), measured.start_time());
    ASSERT_EQ(made->sweeps.size(), measured.sweeps.size());
    for (std::size_t i = 0; i < measured.sweeps.size(); ++i) {
        const level2::Sweep &copy = made->sweeps[i], &sweep = measured.sweeps[i];
        ASSERT_EQ(copy.radials.size(), sweep.radials.size());
        for (std::size_t radial = 0; radial < sweep.radials.size(); ++radial) {
            EXPECT_EQ(copy.radials[radial].azimuth_deg, sweep.radials[radial].azimuth_deg);
            EXPECT_EQ(copy.radials[radial].time, sweep.radials[radial].time);
            EXPECT_EQ(copy.radials[radial].nyquist_mps, sweep.radials[radial].nyquist_mps);
        }
        const std::size_t velocities = moments_of(sweep, Moment::vel).size();
        EXPECT_EQ(moments_of(copy, Moment::vel).size(), velocities);
        EXPECT_EQ(moments_of(copy, Moment::veld).size(), velocities);
        EXPECT_EQ(copy.moments.size(), 2 * velocities);
    }
    EXPECT_GT(compare_gates(*made).folded, 1000);
    EXPECT_FALSE(level2::holds(measured, Moment::veld));
}

}  // namespace
}  // namespace stormcellar::retrieve
