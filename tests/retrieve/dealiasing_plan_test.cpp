// Tests the plan of dealiasing with winds whose folds are known.
#include "retrieve/plan/dealiasing_plan.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stormcellar/accuracy/budget.h"
#include "tests/retrieve/folded_volume.h"

namespace stormcellar::retrieve {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;

const synth::Wind turning{{{0, {0, 8}}, {8000, {45, 0}}}};

// Two storms without echo between them. Neighbors cannot show how often the far storm is folded.
FoldedVolume two_storms() {
    FoldedSpec spec;
    spec.nyquist_mps = 10;
    spec.elevations_deg = {0.5, 1.0, 1.5, 2.0};
    const RadialVelocity wind = along_beam(turning);
    return fold(spec, [&](double azimuth, double range, double elevation, double height) {
        const bool is_near = range < 30'000;
        const bool is_far = azimuth > 40 && azimuth < 100 && range > 70'000;
        if (!is_near && !is_far) return std::nan("");
        return wind(azimuth, range, elevation, height);
    });
}

FoldedVolume unfolded() {
    FoldedSpec spec;
    spec.nyquist_mps = 60;
    spec.elevations_deg = {0.5, 1.5};
    return fold(spec, turning);
}

DealiasingPlan planned(const level2::Volume& volume, const char* budget,
                       Dealiasing asked = Dealiasing::automatic) {
    const auto made = plan_dealiasing(volume, asked, accuracy::parse_budget(budget).value());
    EXPECT_TRUE(made) << made.error().message;
    return made.value_or(DealiasingPlan{});
}

std::vector<std::string> reasons_of(const accuracy::Plan& plan) {
    std::vector<std::string> reasons;
    for (const accuracy::Decision& decision : plan.decisions)
        reasons.push_back(decision.reason);
    return reasons;
}

TEST(DealiasingPlan, LeavesOffWhatNothingNeeds) {
    const FoldedVolume folded = unfolded();
    for (const char* budget : {"0 m/s", "1 m/s", "1 ms"}) {
        const DealiasingPlan made = planned(folded.volume, budget);
        EXPECT_TRUE(made.plan.meets_budget);
        EXPECT_EQ(made.rung, Dealiasing::automatic);
        EXPECT_EQ(made.plan.description, "dealiasing: off");
        EXPECT_EQ(made.plan.cost_s, 0);
        EXPECT_THAT(reasons_of(made.plan), Each("changes nothing here"));
    }
}

// A turn is 20 m/s.
TEST(DealiasingPlan, TakesTheRungThatTheBudgetNeeds) {
    const FoldedVolume folded = two_storms();
    const DealiasingPlan exact = planned(folded.volume, "1 m/s");
    EXPECT_TRUE(exact.plan.meets_budget) << exact.plan.shortfall;
    EXPECT_EQ(exact.rung, Dealiasing::anchored);
    const std::string by_a_turn = "without it 20 m/s would be left off, of 1 m/s allowed";
    EXPECT_THAT(reasons_of(exact.plan),
                ElementsAre("how much it matters has no bound",
                            "without it 40 m/s would be left off, of 1 m/s allowed", by_a_turn));
    EXPECT_EQ(exact.plan.left_off.value, 0);

    const DealiasingPlan loose = planned(folded.volume, "25 m/s");
    EXPECT_TRUE(loose.plan.meets_budget);
    EXPECT_EQ(loose.rung, Dealiasing::region);
    EXPECT_EQ(loose.plan.left_off.value, 20);
    EXPECT_EQ(loose.plan.decisions[2].reason, "small: all that is left off is within the budget");

    EXPECT_EQ(planned(folded.volume, "500 m/s").rung, Dealiasing::profile)
        << "folded velocities are off without any bound";
    EXPECT_FALSE(planned(folded.volume, "0.0001 ms").plan.meets_budget);
    EXPECT_EQ(planned(folded.volume, "1000 s").rung, Dealiasing::anchored);
}

TEST(DealiasingPlan, HasAValidChain) {
    accuracy::Chain chain = dealiasing_chain(Dealiasing::automatic);
    predict_dealiasing(two_storms().volume, chain);
    EXPECT_TRUE(accuracy::validate(chain));
    ASSERT_EQ(chain.steps.size(), 1U);
    EXPECT_EQ(chain.steps[0].rung_name(3), "anchored");
    double cost_s = 0;
    for (const accuracy::Effect& effect : chain.steps[0].effects)
        cost_s += effect.cost_s;
    EXPECT_GT(cost_s, 0);
}

TEST(DealiasingPlan, FollowsTheRungThatWasAsked) {
    const FoldedVolume folded = two_storms();
    const DealiasingPlan made = planned(folded.volume, "1 m/s", Dealiasing::region);
    EXPECT_EQ(made.rung, Dealiasing::region);
    EXPECT_THAT(reasons_of(made.plan), ElementsAre("set on", "set on", "set off"));
}

TEST(DealiasingPlan, WithoutABudgetIsAsAutomaticDealiasing) {
    for (const FoldedVolume& folded : {two_storms(), unfolded()}) {
        const auto made = plan_dealiasing(folded.volume, Dealiasing::automatic, std::nullopt);
        ASSERT_TRUE(made) << made.error().message;
        EXPECT_EQ(dealias(folded.volume, made->rung).rung,
                  dealias(folded.volume, Dealiasing::automatic).rung);
    }
    EXPECT_TRUE(plan_dealiasing({}, Dealiasing::automatic, std::nullopt)) << "no velocities";
}

}  // namespace
}  // namespace stormcellar::retrieve
