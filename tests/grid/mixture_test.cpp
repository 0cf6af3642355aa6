// Tests each case of the status rule (docs/geometry.md), and means on a circle. In the messages, v,
// n, f, a and u are the weights of values, no echo, range folded, ambiguous and not seen.
#include "grid/sweep/mixture.h"

#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace stormcellar::grid {
namespace {

const Sample unseen{};
const Sample folded{CellStatus::range_folded, 0, 0, 0};
const Sample ambiguous{CellStatus::ambiguous, 0, 0, 0};
Sample valued(float value, float half_period = 0) {
    return {CellStatus::value, value, 0, half_period};
}
Sample quiet(float limit_dbz) {
    return {CellStatus::no_echo, 0, limit_dbz, 0};
}
CellResult mix(const Sample& a, const Sample& b, float weight_b,
               Blending blending = Blending::with_detection_limit) {
    return blend(a, b, weight_b, blending);
}

TEST(Blend, TwoValuesAreLinear) {
    const CellResult cell = mix(valued(10), valued(30), 0.25F);
    EXPECT_EQ(cell.status, CellStatus::value);
    EXPECT_FLOAT_EQ(cell.value, 15);
}

TEST(Blend, ValueAndNoEcho) {
    EXPECT_EQ(mix(valued(20), quiet(-10), 0.5F).status, CellStatus::value) << "v = n gives a value";
    EXPECT_FLOAT_EQ(mix(valued(20), quiet(-10), 0.5F).value, 5);
    EXPECT_FLOAT_EQ(mix(valued(20), quiet(-10), 0.25F).value, 12.5F);
    EXPECT_EQ(mix(valued(20), quiet(-10), 0.51F).status, CellStatus::no_echo);
    EXPECT_FLOAT_EQ(mix(quiet(-10), valued(20), 0.75F).value, 12.5F);
}

TEST(Blend, NoEchoNeverEntersOtherMoments) {
    EXPECT_FLOAT_EQ(mix(valued(20), quiet(-10), 0.25F, Blending::values_only).value, 20);
    EXPECT_FLOAT_EQ(mix(valued(20), quiet(-10), 0.25F, Blending::nyquist_circle).value, 20);
    EXPECT_EQ(mix(valued(20), quiet(-10), 0.6F, Blending::nyquist_circle).status,
              CellStatus::no_echo);
}

TEST(Blend, ValueAndNotSeen) {
    EXPECT_EQ(mix(valued(20), unseen, 0.5F).status, CellStatus::value) << "u is not over one half";
    EXPECT_FLOAT_EQ(mix(valued(20), unseen, 0.4F).value, 20);
    EXPECT_EQ(mix(valued(20), unseen, 0.51F).status, CellStatus::not_seen);
}

TEST(Blend, NoEchoAndNotSeen) {
    EXPECT_EQ(mix(quiet(0), unseen, 0.5F).status, CellStatus::no_echo);
    EXPECT_EQ(mix(quiet(0), unseen, 0.51F).status, CellStatus::not_seen);
}

TEST(Blend, FoldedNeedsTheLargestShare) {
    EXPECT_EQ(mix(folded, valued(20), 0.4F).status, CellStatus::range_folded);
    EXPECT_EQ(mix(folded, valued(20), 0.5F).status, CellStatus::value);
    EXPECT_FLOAT_EQ(mix(folded, valued(20), 0.6F).value, 20)
        << "range folding never enters a value";
    EXPECT_EQ(mix(folded, quiet(0), 0.4F).status, CellStatus::range_folded);
    EXPECT_EQ(mix(folded, quiet(0), 0.5F).status, CellStatus::no_echo);
    EXPECT_EQ(mix(folded, unseen, 0.5F).status, CellStatus::range_folded);
    EXPECT_EQ(mix(folded, unseen, 0.51F).status, CellStatus::not_seen);
}

TEST(Blend, AmbiguousNeedsTheLargestShare) {
    const auto mixed = [](const Sample& a, const Sample& b, float weight_b) {
        return mix(a, b, weight_b, Blending::values_only);
    };
    EXPECT_EQ(mixed(ambiguous, valued(20), 0.4F).status, CellStatus::ambiguous);
    EXPECT_EQ(mixed(ambiguous, valued(20), 0.5F).status, CellStatus::value);
    EXPECT_FLOAT_EQ(mixed(ambiguous, valued(20), 0.6F).value, 20);
    EXPECT_EQ(mixed(ambiguous, quiet(0), 0.4F).status, CellStatus::ambiguous);
    EXPECT_EQ(mixed(ambiguous, quiet(0), 0.5F).status, CellStatus::no_echo);
    EXPECT_EQ(mixed(ambiguous, unseen, 0.5F).status, CellStatus::ambiguous);
    EXPECT_EQ(mixed(ambiguous, unseen, 0.51F).status, CellStatus::not_seen);
    EXPECT_EQ(mixed(ambiguous, folded, 0.4F).status, CellStatus::ambiguous);
    EXPECT_EQ(mixed(ambiguous, folded, 0.5F).status, CellStatus::range_folded);
}

// Echo of unknown velocity outweighs values if f + a is the largest, even if neither f nor a is.
TEST(Mixture, FoldedAndAmbiguousCountTogether) {
    Mixture mixture;
    mixture.add(valued(20), 4, Blending::values_only);
    mixture.add(folded, 2, Blending::values_only);
    mixture.add(ambiguous, 3, Blending::values_only);
    EXPECT_EQ(mixture.result(Blending::values_only).status, CellStatus::ambiguous);
    mixture.add_counted(CellStatus::range_folded, 2, 0, Blending::values_only);
    EXPECT_EQ(mixture.result(Blending::values_only).status, CellStatus::range_folded);
    mixture.add(valued(10), 4, Blending::values_only);
    EXPECT_FLOAT_EQ(mixture.result(Blending::values_only).value, 15);
    EXPECT_FLOAT_EQ(mixture.weight(), 15);
}

TEST(Blend, EqualStatesStay) {
    for (const float weight : {0.0F, 0.3F, 0.5F, 1.0F}) {
        EXPECT_EQ(mix(unseen, unseen, weight).status, CellStatus::not_seen);
        EXPECT_EQ(mix(folded, folded, weight).status, CellStatus::range_folded);
        EXPECT_EQ(mix(ambiguous, ambiguous, weight).status, CellStatus::ambiguous);
        EXPECT_EQ(mix(quiet(0), quiet(5), weight).status, CellStatus::no_echo);
    }
}

TEST(Blend, VelocitiesAreLinearOnTheNyquistCircle) {
    const auto circle = Blending::nyquist_circle;
    EXPECT_FLOAT_EQ(mix(valued(10, 25), valued(20, 25), 0.25F, circle).value, 12.5F);
    // From 24 up to -24 (which is 26 on the circle), the mean is 25, the same as -25.
    EXPECT_FLOAT_EQ(mix(valued(24, 25), valued(-24, 25), 0.5F, circle).value, -25);
    EXPECT_FLOAT_EQ(mix(valued(24, 25), valued(-24, 25), 0.25F, circle).value, 24.5F);
    EXPECT_FLOAT_EQ(mix(valued(24, 25), valued(-24, 25), 0.75F, circle).value, -24.5F);
}

TEST(Blend, VelocitiesOfDifferentCirclesAreNotAveraged) {
    const auto circle = Blending::nyquist_circle;
    EXPECT_EQ(mix(valued(-5, 8.4F), valued(25, 33.5F), 0.4F, circle).value, -5);
    EXPECT_EQ(mix(valued(-5, 8.4F), valued(25, 33.5F), 0.6F, circle).value, 25);
    EXPECT_EQ(mix(valued(-25), valued(25), 0.4F, circle).value, -25)
        << "a TDWR gives a Nyquist velocity of 0";
    EXPECT_EQ(mix(valued(-25), valued(25), 0.6F, circle).value, 25);
}

TEST(Blend, PhasesStayBetween0And360) {
    const auto circle = Blending::phase_circle;
    EXPECT_FLOAT_EQ(mix(valued(350, 180), valued(20, 180), 0.5F, circle).value, 5);
    EXPECT_FLOAT_EQ(mix(valued(200, 180), valued(220, 180), 0.5F, circle).value, 210);
    EXPECT_FLOAT_EQ(mix(valued(359, 180), valued(357, 180), 0.5F, circle).value, 358);
}

TEST(BlendingOf, EachMoment) {
    EXPECT_EQ(blending_of(level2::Moment::ref), Blending::with_detection_limit);
    EXPECT_EQ(blending_of(level2::Moment::vel), Blending::nyquist_circle);
    EXPECT_EQ(blending_of(level2::Moment::phi), Blending::phase_circle);
    EXPECT_EQ(blending_of(level2::Moment::rho), Blending::values_only);
    EXPECT_EQ(blending_of(level2::Moment::veld), Blending::values_only) << "VELD does not wrap";
}

TEST(Mixture, AnEmptyOneIsNotSeen) {
    EXPECT_EQ(Mixture{}.result(Blending::values_only).status, CellStatus::not_seen);
}

TEST(Mixture, WeightsNeedNotSumToOne) {
    Mixture mixture;
    for (const float value : {10.0F, 20.0F, 60.0F})
        mixture.add(valued(value), 7, Blending::values_only);
    mixture.add(quiet(0), 20, Blending::values_only);
    const CellResult cell = mixture.result(Blending::values_only);
    EXPECT_EQ(cell.status, CellStatus::value);
    EXPECT_FLOAT_EQ(cell.value, 30);
}

TEST(Mixture, OfMixturesIsThatOfTheirSamples) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> share(0, 1);
    const std::vector<Sample> kinds = {unseen,     folded,     ambiguous,
                                       valued(10), valued(33), quiet(-5)};
    for (int trial = 0; trial < 2000; ++trial) {
        const Blending blending = Blending::with_detection_limit;
        Mixture flat;
        Mixture outer;
        for (int part = 0; part < 3; ++part) {
            Mixture inner;
            const float weight = share(random);
            for (int i = 0; i < 4; ++i) {
                const Sample& sample = kinds[random() % kinds.size()];
                const float own = share(random);
                inner.add(sample, own, blending);
                flat.add(sample, weight * own, blending);
            }
            outer.add(inner, weight, blending);
        }
        const CellResult a = flat.result(blending);
        const CellResult b = outer.result(blending);
        ASSERT_EQ(a.status, b.status);
        ASSERT_NEAR(a.value, b.value, 1e-4);
    }
}

}  // namespace
}  // namespace stormcellar::grid
