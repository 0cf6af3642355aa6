// Compares KDP with the truth of synthetic ramps: constant KDP, steps, cores, wraps, gaps, speckle
// and backscatter phase. Also compares the stated error with the real error.
#include "stormcellar/retrieve/kdp.h"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/retrieve/phase_ramp.h"

namespace stormcellar::retrieve {
namespace {

double core(double km, double middle_km, double width_km) {
    const double x = (km - middle_km) / width_km;
    return std::exp(-0.5 * x * x);
}

std::vector<float> values_of(const level2::Volume& volume) {
    return specific_differential_phases(volume).at(0).deg_per_km;
}

struct RampCase {
    const char* name;
    PhaseRamp ramp;
    double most_rms;  // degrees/km
};

const RampCase ramp_cases[] = {
    {"constant", {[](double) { return 1.0; }}, 0.035},
    {"negative", {[](double) { return -0.5; }}, 0.035},
    {"weak", {[](double) { return 0.1; }}, 0.035},
    {"weak, noisy", {[](double) { return 0.1; }, 3}, 0.055},
    {"slow", {[](double km) { return core(km, 52, 15); }}, 0.05},
    {"wraps", {[](double km) { return km > 12 && km < 92 ? 4.0 : 0.0; }, 2, 300}, 0.3},
    {"step", {[](double km) { return km > 42 && km < 52 ? 3.0 : 0.0; }}, 0.3},
    {"core of 3 km", {[](double km) { return 5 * core(km, 52, 1.5); }}, 0.22},
    {"two cores",
     {[](double km) { return 0.2 + 3 * core(km, 37, 3) + 2 * core(km, 62, 5); }},
     0.15},
    {"noise of 6 degrees", {[](double km) { return 3 * core(km, 52, 3); }, 6}, 0.3},
    {"gaps", {[](double) { return 1.5; }, 2, 60, 0, true}, 0.055},
    {"backscatter", {[](double) { return 0.5; }, 2, 60, 8}, 0.05},
    {"speckle", {[](double) { return 1.0; }, 2, 60, 0, false, 0.1}, 0.06},
};

struct RampScore {
    double rms = 0, share = 0, within_one = 0, within_two = 0;
};

// Compares all gates that have a phase and, if there is speckle, a high correlation.
RampScore score_of(const PhaseRamp& ramp) {
    const level2::Volume volume = volume_of_ramp(ramp);
    const auto all = specific_differential_phases(volume);
    RampScore score;
    double phases = 0, count = 0;
    for (int radial = 0; radial < ramp_radials; ++radial)
        for (int gate = 0; gate < ramp_gates; ++gate) {
            const auto at = static_cast<std::size_t>(radial * ramp_gates + gate);
            if (volume.sweeps[0].moments[0].codes16[at] == 0) {
                EXPECT_TRUE(std::isnan(all.at(0).deg_per_km[at]));
                continue;
            }
            ++phases;
            const auto value = static_cast<double>(all.at(0).deg_per_km[at]);
            if (std::isnan(value)) continue;
            ++count;
            const double error = static_cast<double>(all.at(0).error_deg_per_km[at]);
            const double off = std::abs(value - ramp.kdp(ramp_range_km(gate)));
            score.rms += off * off;
            score.within_one += off <= error ? 1 : 0;
            score.within_two += off <= 2 * error ? 1 : 0;
        }
    score.rms = std::sqrt(score.rms / count);
    score.within_one /= count;
    score.within_two /= count;
    score.share = count / phases;
    return score;
}

TEST(Kdp, IsTheSlopeOfRampsWithinTheStatedErrors) {
    for (const RampCase& one : ramp_cases) {
        const RampScore score = score_of(one.ramp);
        EXPECT_LE(score.rms, one.most_rms) << one.name;
        EXPECT_GE(score.share, 0.99) << one.name;
        EXPECT_GE(score.within_one, 0.8) << one.name;
        EXPECT_GE(score.within_two, 0.93) << one.name;
        ::testing::Test::RecordProperty(std::string(one.name) + " rms", std::to_string(score.rms));
    }
}

// Weak KDP keeps its sign: the mean is not pulled toward positive values.
TEST(Kdp, HasNoBiasWhereItIsNegative) {
    for (const double kdp : {-0.1, 0.0, 0.1}) {
        const auto values = values_of(volume_of_ramp({[kdp](double) { return kdp; }, 3}));
        double sum = 0;
        for (const float value : values)
            sum += static_cast<double>(value);
        EXPECT_NEAR(sum / static_cast<double>(values.size()), kdp, 0.005);
    }
}

// The stated error is not merely large: where KDP is constant, it is at most twice the real error.
TEST(Kdp, ErrorsAreNoLargerThanNeeded) {
    const PhaseRamp ramp{[](double) { return 1.0; }};
    const auto all = specific_differential_phases(volume_of_ramp(ramp));
    double errors = 0;
    for (const float error : all.at(0).error_deg_per_km)
        errors += static_cast<double>(error);
    EXPECT_LE(errors / (ramp_radials * ramp_gates), 2 * score_of(ramp).rms);
}

// Without the search for backscatter phase, KDP beside the bump would be 5 degrees/km off.
TEST(Kdp, BackscatterPhaseIsLeftOut) {
    const PhaseRamp ramp{[](double) { return 0.5; }, 1, 60, 8};
    const auto all = specific_differential_phases(volume_of_ramp(ramp));
    for (int radial = 0; radial < ramp_radials; ++radial)
        for (int gate = 190; gate < 210; ++gate)
            EXPECT_NEAR(all.at(0).deg_per_km[static_cast<std::size_t>(radial * ramp_gates + gate)],
                        0.5F, 0.4F)
                << radial << " " << gate;
}

TEST(Kdp, IsNotFittedToPhasesWithoutCorrelation) {
    level2::Volume volume = volume_of_ramp({[](double) { return 1.0; }});
    for (std::uint8_t& code : volume.sweeps[0].moments[1].codes8)
        code = 120;  // a correlation of 0.6
    for (const float value : values_of(volume))
        EXPECT_TRUE(std::isnan(value));
}

TEST(Kdp, HardCasesGiveNoNumbers) {
    EXPECT_TRUE(specific_differential_phases({}).empty());
    level2::Volume volume = volume_of_ramp({[](double) { return 1.0; }});
    level2::Volume lone = volume;
    auto& codes = lone.sweeps[0].moments[0].codes16;
    for (std::size_t at = 0; at < codes.size(); ++at)
        if (at % ramp_gates > 3) codes[at] = 1;  // range folded
    for (const float value : values_of(lone))
        EXPECT_TRUE(std::isnan(value)) << "four gates are too few";
    level2::Volume without = volume;
    without.sweeps[0].moments.pop_back();
    EXPECT_NEAR(specific_differential_phases(without).at(0).deg_per_km[200], 1, 0.3)
        << "no correlation is sent";
    level2::Volume no_spacing = volume;
    no_spacing.sweeps[0].moments[0].gate_spacing_m = 0;
    EXPECT_TRUE(specific_differential_phases(no_spacing).empty());
    level2::Volume coarse = volume;
    for (auto& moment : coarse.sweeps[0].moments)
        moment.gate_spacing_m = 1'000'000;
    for (const float value : values_of(coarse))
        EXPECT_FALSE(std::isinf(value));
}

}  // namespace
}  // namespace stormcellar::retrieve
