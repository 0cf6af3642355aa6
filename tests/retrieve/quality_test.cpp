// Tests the probability of weather against dual polarization, and on volumes that lack something.
#include "stormcellar/retrieve/quality.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "retrieve/derived/quality_moment.h"
#include "retrieve/quality/additive_rule.h"
#include "stormcellar/level2/decode.h"
#include "stormcellar/retrieve/derived_moments.h"
#include "tests/testing/data.h"

namespace stormcellar::retrieve {
namespace {

using level2::GateStatus;
using level2::Moment;

level2::Volume volume_of(const std::string& name) {
    auto decoded = level2::decode_file(testing::real_file("volumes/" + name));
    if (!decoded) throw std::runtime_error(decoded.error().message);
    return std::move(decoded->volume);
}

struct Shares {
    double removed = 0;  // of gates with a correlation below 0.8
    double kept = 0;     // of gates of at least 20 dBZ with a correlation of at least 0.95
};

Shares shares_of(const level2::Volume& volume, bool only_single) {
    double other = 0, removed = 0, weather = 0, kept = 0;
    for (const SweepQuality& quality : weather_probabilities(volume, only_single)) {
        const level2::Sweep& sweep = volume.sweeps[quality.sweep];
        const level2::SweepMoment& ref = sweep.moments[quality.moment];
        const level2::SweepMoment* rho = sweep.find(Moment::rho);
        if (rho == nullptr) continue;
        EXPECT_EQ(rho->first_gate_m, ref.first_gate_m);
        for (std::size_t radial = 0; radial < sweep.radials.size(); ++radial)
            for (std::int32_t gate = 0; gate < ref.gate_stride; ++gate) {
                if (ref.status(radial, gate) != GateStatus::valid ||
                    rho->status(radial, gate) != GateStatus::valid)
                    continue;
                const float correlation = rho->value_of(rho->code(radial, gate));
                const float probability =
                    quality.probabilities[radial * static_cast<std::size_t>(ref.gate_stride) +
                                          static_cast<std::size_t>(gate)];
                if (correlation < 0.8F) {
                    ++other;
                    removed += probability < 0.5F ? 1 : 0;
                } else if (correlation >= 0.95F && ref.value_of(ref.code(radial, gate)) >= 20) {
                    ++weather;
                    kept += probability >= 0.5F ? 1 : 0;
                }
            }
    }
    EXPECT_GT(other, 10'000);
    EXPECT_GT(weather, 10'000);
    return {removed / other, kept / weather};
}

// The rules were not made from the volume of KDMX of March 2022. Its echo that is not weather is
// amid snow, so this volume is the hardest of the five that score the rules.
TEST(Quality, TellsWeatherInAVolumeThatDidNotTeach) {
    STORMCELLAR_NEED_DATA();
    const level2::Volume volume = volume_of("KDMX20220305_232324.trimmed.ar2v");
    const Shares dual = shares_of(volume, false);
    EXPECT_GE(dual.removed, 0.94);
    EXPECT_GE(dual.kept, 0.98);
    const Shares single = shares_of(volume, true);
    EXPECT_GE(single.removed, 0.90);
    EXPECT_GE(single.kept, 0.96);
}

// A Doppler cut measures the same air seconds later, without dual polarization.
TEST(Quality, ADopplerCutTakesTheProbabilityOfTheCutWithDualPolarization) {
    STORMCELLAR_NEED_DATA();
    const level2::Volume volume = volume_of("KDMX20220305_232324.trimmed.ar2v");
    const auto qualities = weather_probabilities(volume);
    ASSERT_EQ(qualities.size(), 3U);
    const level2::SweepMoment& from = volume.sweeps[0].moments[qualities[0].moment];
    const level2::SweepMoment& to = volume.sweeps[1].moments[qualities[1].moment];
    ASSERT_EQ(volume.sweeps[1].find(Moment::rho), nullptr);
    ASSERT_EQ(from.first_gate_m, to.first_gate_m);
    const auto at = [](const SweepQuality& quality, const level2::SweepMoment& moment,
                       std::size_t radial, std::size_t gate) {
        return quality.probabilities[radial * static_cast<std::size_t>(moment.gate_stride) + gate];
    };
    const float azimuth = volume.sweeps[1].radials[100].azimuth_deg;
    const auto& radials = volume.sweeps[0].radials;
    const auto nearest = std::ranges::min_element(radials, {}, [&](const level2::Radial& radial) {
        return std::abs(radial.azimuth_deg - azimuth);
    });
    const auto radial = static_cast<std::size_t>(nearest - radials.begin());
    int compared = 0;
    for (std::size_t gate = 0; gate < 1192; ++gate) {
        const float copied = at(qualities[1], to, 100, gate);
        if (std::isnan(copied)) continue;
        EXPECT_EQ(copied, at(qualities[0], from, radial, gate)) << gate;
        ++compared;
    }
    EXPECT_GT(compared, 100);
}

level2::Volume one_sweep(int radials, int gates, std::uint8_t code) {
    level2::Volume volume;
    level2::Sweep& sweep = volume.sweeps.emplace_back();
    level2::SweepMoment& moment = sweep.moments.emplace_back();
    moment.gate_spacing_m = 1000;
    moment.gate_stride = gates;
    moment.scale = 2;
    moment.offset = 66;
    for (int i = 0; i < radials; ++i) {
        sweep.radials.emplace_back().azimuth_deg = static_cast<float>(i);
        moment.gate_counts.push_back(static_cast<std::uint16_t>(gates));
    }
    moment.codes8.assign(static_cast<std::size_t>(radials * gates), code);
    return volume;
}

// Each gate with echo gets a probability. The gates of a volume without gate spacing get no
// probability.
TEST(Quality, HardCasesHaveAProbabilityForEachGateWithEcho) {
    EXPECT_TRUE(weather_probabilities({}).empty());
    for (const auto& [radials, gates] : {std::pair{1, 1}, {2, 3}, {360, 1}, {1, 460}, {367, 460}})
        for (const std::uint8_t code : {std::uint8_t{0}, std::uint8_t{1}, std::uint8_t{100}}) {
            const auto qualities = weather_probabilities(one_sweep(radials, gates, code));
            ASSERT_EQ(qualities.size(), 1U);
            for (const float probability : qualities.front().probabilities) {
                if (code < 2)
                    EXPECT_TRUE(std::isnan(probability));
                else
                    EXPECT_TRUE(probability > 0 && probability < 1) << probability;
            }
        }
    level2::Volume no_spacing = one_sweep(10, 10, 100);
    no_spacing.sweeps.front().moments.front().gate_spacing_m = 0;
    EXPECT_TRUE(weather_probabilities(no_spacing).empty());
}

TEST(Quality, TablesAreLinearBetweenKnotsAndConstantBeyond) {
    constexpr std::array knots = {Knot{0, -1}, Knot{10, 1}, Knot{20, 5}};
    const std::array terms = {RuleTerm{Feature::width, 7, knots}};
    const RuleTables tables(AdditiveRule{0.5F, terms});
    EXPECT_EQ(tables.constant(), 0.5F);
    const std::array<float, 6> values = {-3, 0, 5, 15, 99, std::nanf("")};
    std::array<float, 6> found{};
    tables.add(Feature::width, values, found.data());
    const std::array<float, 6> expected = {-1, -1, 0, 3, 5, 7};
    for (std::size_t i = 0; i < values.size(); ++i)
        EXPECT_NEAR(found[i], expected[i], 0.01F) << i;
}

// The moment POW has the flags of REF, and its values are the probabilities within half a step.
TEST(QualityMoment, HasTheFlagsOfReflectivityAndTheProbabilities) {
    STORMCELLAR_NEED_DATA();
    level2::Volume volume = volume_of("KDMX20220305_232324.trimmed.ar2v");
    const auto qualities = weather_probabilities(volume);
    ASSERT_TRUE(add_derived_moments(volume, std::array{Moment::pow}));
    for (const SweepQuality& quality : qualities) {
        const level2::Sweep& sweep = volume.sweeps[quality.sweep];
        const level2::SweepMoment& ref = sweep.moments[quality.moment];
        const level2::SweepMoment* pow = sweep.find(Moment::pow);
        ASSERT_NE(pow, nullptr);
        for (std::size_t radial = 0; radial < sweep.radials.size(); radial += 7)
            for (std::int32_t gate = 0; gate < ref.gate_stride; ++gate) {
                const float probability =
                    quality.probabilities[radial * static_cast<std::size_t>(ref.gate_stride) +
                                          static_cast<std::size_t>(gate)];
                const GateStatus status = pow->status(radial, gate);
                if (ref.status(radial, gate) != GateStatus::valid)
                    ASSERT_EQ(status, ref.status(radial, gate));
                else if (std::isnan(probability))
                    ASSERT_EQ(status, GateStatus::ambiguous);
                else
                    ASSERT_NEAR(pow->value_of(pow->code(radial, gate)), probability, 0.0021F);
            }
    }
    EXPECT_EQ(volume.sweeps[1].find(Moment::veld), nullptr);
}

// Gates, also gates of velocity, are left out if and only if POW is below the limit.
TEST(QualityMoment, LeavesOutGatesBelowTheLimitAndNoOthers) {
    STORMCELLAR_NEED_DATA();
    level2::Volume judged = volume_of("KDMX20220305_232324.trimmed.ar2v");
    level2::Volume kept = judged;
    add_quality_moment(judged);
    const auto derived =
        add_derived_moments(kept, std::array{Moment::ref}, {Dealiasing::automatic, {}, 0.5});
    ASSERT_TRUE(derived);
    std::int64_t echo = 0, left_out = 0;
    for (std::size_t s = 0; s < judged.sweeps.size(); ++s) {
        const level2::Sweep& sweep = judged.sweeps[s];
        const level2::SweepMoment* pow = sweep.find(Moment::pow);
        for (const Moment moment : {Moment::ref, Moment::vel, Moment::zdr}) {
            const level2::SweepMoment* before = sweep.find(moment);
            if (before == nullptr) continue;
            const level2::SweepMoment* after = kept.sweeps[s].find(moment);
            ASSERT_EQ(before->first_gate_m, pow->first_gate_m);
            for (std::size_t radial = 0; radial < sweep.radials.size(); ++radial)
                for (std::int32_t gate = 0; gate < before->gate_stride; ++gate) {
                    const bool is_judged = pow->status(radial, gate) == GateStatus::valid;
                    const bool is_echo = before->status(radial, gate) == GateStatus::valid;
                    const bool is_low = is_judged && pow->value_of(pow->code(radial, gate)) < 0.5F;
                    ASSERT_EQ(after->code(radial, gate),
                              is_echo && is_low ? 0 : before->code(radial, gate));
                    if (moment != Moment::ref) continue;
                    echo += is_echo ? 1 : 0;
                    left_out += is_echo && is_low ? 1 : 0;
                }
        }
    }
    ASSERT_GT(left_out, 0);
    // In this volume of snow, most of the echo that is left out is of the kind `other`.
    const std::string text = quality_in_notes(derived->notes);
    const std::string begin =
        fmt::format("probability of weather at least 0.5; {:.1f} % of the echo left out: other ",
                    100 * static_cast<double>(left_out) / static_cast<double>(echo));
    EXPECT_TRUE(text.starts_with(begin)) << text;
    EXPECT_NE(text.find(" %, birds and insects "), text.npos) << text;
    EXPECT_EQ(quality_in_notes({}), "");
}

}  // namespace
}  // namespace stormcellar::retrieve
