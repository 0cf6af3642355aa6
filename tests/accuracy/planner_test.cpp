#include "stormcellar/accuracy/planner.h"

#include <functional>
#include <limits>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/accuracy/small_chain.h"

namespace stormcellar::accuracy {
namespace {

using ::testing::HasSubstr;
using testing::plan_of;
using testing::random_chain;
using testing::small_chain;
using Rungs = std::vector<std::size_t>;

Budget budget_of(const char* text) {
    auto budget = parse_budget(text);
    EXPECT_TRUE(budget) << text;
    return budget.value_or(Budget{});
}

TEST(Planner, TheSumOfWhatIsLeftOffIsWithinTheBudgetNotEachAlone) {
    // The position errors are 200, 240 and 30 m. Each error alone is within 250 m, but the sum of
    // all three is not.
    const Plan made = plan_of(small_chain(), "250 m, 0.5 dB");
    EXPECT_TRUE(made.meets_budget);
    EXPECT_EQ(made.choice.rungs, (Rungs{0, 1, 0}));
    EXPECT_EQ(made.left_off, (ErrorSize{230, 0.3, 0}));
    EXPECT_DOUBLE_EQ(made.cost_s, 1.1);
    EXPECT_EQ(made.description, "beam: 4/3 earth, frame: ellipsoid, averaging: decibels");
}

TEST(Planner, EveryBudgetedQuantityCounts) {
    EXPECT_EQ(plan_of(small_chain(), "470 m").choice.rungs, (Rungs{0, 0, 0}));
    EXPECT_EQ(plan_of(small_chain(), "469 m").choice.rungs, (Rungs{0, 1, 0}));
    EXPECT_EQ(plan_of(small_chain(), "469 m, 0.2 dB").choice.rungs, (Rungs{0, 1, 1}));
    EXPECT_EQ(plan_of(small_chain(), "0.2 dB").choice.rungs, (Rungs{0, 0, 1}));
    EXPECT_EQ(plan_of(small_chain(), "0 m, 0 dB").choice.rungs, (Rungs{1, 2, 1}));
}

TEST(Planner, AnEffectThatChangesNothingStaysOffEvenWhenExact) {
    Chain chain = small_chain();
    chain.steps[0].effects[0].predicted = {};
    EXPECT_EQ(plan_of(chain, "0 m, 0 dB").choice.rungs, (Rungs{0, 2, 1}));
}

// Refraction is set off, and its error alone exceeds the budget. The other quantities and effects
// must still count.
TEST(Planner, TheBestOfThoseThatAllMissIsTheMostAccurateInTheRest) {
    Chain chain = small_chain();
    chain.steps[0].effects[0].setting = Setting::off;
    const Plan none = plan_of(chain, "0 m, 0 dB");
    EXPECT_FALSE(none.meets_budget);
    EXPECT_EQ(none.choice.rungs, (Rungs{0, 2, 1}));
}

TEST(Planner, AnEffectWithoutABoundIsOn) {
    Chain chain = small_chain();
    chain.steps[0].effects[0].predicted.value = std::numeric_limits<double>::infinity();
    EXPECT_EQ(plan_of(chain, "100 km, 100 dB").choice.rungs[0], 1U);
    EXPECT_EQ(plan_of(chain, "100 km").choice.rungs[0], 1U)
        << "no budget allows an unbounded error";
    EXPECT_EQ(plan_of(chain, "1 s").choice.rungs[0], 1U)
        << "a time budget allows no unbounded error, either";
    chain.steps[0].effects[0].setting = Setting::off;
    EXPECT_TRUE(plan_of(chain, "100 km").meets_budget) << "the user set the effect off";
}

TEST(Planner, ATimeBuysTheMostAccuracyThatFits) {
    EXPECT_EQ(plan_of(small_chain(), "1 s").choice.rungs, (Rungs{0, 0, 0}));
    EXPECT_EQ(plan_of(small_chain(), "2.1 s").choice.rungs, (Rungs{1, 1, 0}));
    EXPECT_EQ(plan_of(small_chain(), "100 s").choice.rungs, (Rungs{1, 2, 1}));
    const Plan slow = plan_of(small_chain(), "900 ms");
    EXPECT_FALSE(slow.meets_budget);
    EXPECT_EQ(slow.choice.rungs, (Rungs{0, 0, 0}));
    EXPECT_THAT(slow.shortfall, HasSubstr("takes 1 s"));
}

TEST(Planner, ErrorsAndATimeMustBothHold) {
    EXPECT_TRUE(plan_of(small_chain(), "250 m, 1.2 s").meets_budget);
    const Plan unmet = plan_of(small_chain(), "20 m, 1.2 s");
    EXPECT_FALSE(unmet.meets_budget);
    EXPECT_EQ(unmet.choice.rungs, (Rungs{0, 1, 0}));  // the most accurate within the time
    EXPECT_EQ(unmet.shortfall,
              "no choice meets the budget of 20 m, 1.2 s: the best, beam: 4/3 earth, frame: "
              "ellipsoid, averaging: decibels, leaves off 230 m, 0.3 dB and takes 1.1 s");
}

TEST(Planner, SettingsInTheWayAreNamed) {
    Chain chain = small_chain();
    chain.steps[1].effects[0].setting = Setting::off;
    chain.steps[2].effects[0].setting = Setting::off;  // has no position error
    const Plan far = plan_of(chain, "100 m");
    EXPECT_FALSE(far.meets_budget);
    EXPECT_EQ(far.choice.rungs, (Rungs{1, 0, 0}));
    EXPECT_THAT(far.shortfall,
                HasSubstr("leaves off 270 m, 0.3 dB and takes 2 s; set off: ellipsoid"));
    EXPECT_EQ(far.shortfall.find("linear_mean"), std::string::npos);

    chain = small_chain();
    chain.steps[0].effects[0].setting = Setting::on;
    const Plan slow = plan_of(chain, "1.5 s");
    EXPECT_FALSE(slow.meets_budget);
    EXPECT_THAT(slow.shortfall, HasSubstr("set on: refraction"));
}

TEST(Planner, BudgetsThatBoundNothingOrInAnotherUnitAreRefused) {
    EXPECT_THAT(plan(small_chain(), Budget{}).error().message, HasSubstr("sets no limit"));
    const auto other = plan(small_chain(), budget_of("0.5 m/s"));
    ASSERT_FALSE(other);
    EXPECT_EQ(other.error().message, "the budget is in m/s, but the values are in dB");
}

// Finds the cheapest choice in another way: depth first, effect by effect, with running sums.
struct Search {
    const Chain& chain;
    const Budget& budget;
    std::optional<double> least_cost_s;
    std::vector<std::size_t> on = {};  // choice (rung) of each step so far

    void step(std::size_t index, double cost_s, ErrorSize off) {
        if (index == chain.steps.size()) {
            for (const JointCost& joint : chain.joint_costs) {
                const bool both =
                    on[joint.step] == joint.rung && on[joint.other_step] == joint.other_rung;
                cost_s += both ? joint.cost_s : 0;
            }
            const bool good = (!budget.position_m || off.position_m <= *budget.position_m) &&
                              (!budget.value || off.value <= *budget.value) &&
                              (!budget.image_de || off.image_de <= *budget.image_de);
            if (good && (!least_cost_s || cost_s < *least_cost_s)) least_cost_s = cost_s;
            return;
        }
        on.push_back(0);
        effect(index, 0, true, cost_s, off);
        on.pop_back();
    }

    void effect(std::size_t index, std::size_t k, bool below_on, double cost_s, ErrorSize off) {
        const auto& effects = chain.steps[index].effects;
        if (k == effects.size()) return step(index + 1, cost_s, off);
        if (below_on && effects[k].setting != Setting::off) {
            ++on[index];
            effect(index, k + 1, true, cost_s + effects[k].cost_s, off);
            --on[index];
        }
        if (effects[k].setting != Setting::on) {
            ErrorSize more = off;
            more += effects[k].predicted;
            effect(index, k + 1, false, cost_s, more);
        }
    }
};

TEST(Planner, IsTheCheapestThatASearchOfAnotherKindFinds) {
    std::mt19937_64 random(20261121);
    int met = 0;
    int unmet = 0;
    for (int trial = 0; trial < 5000; ++trial) {
        const Chain chain = random_chain(random);
        Budget budget;
        budget.position_m = static_cast<double>(random() % 12);
        if (random() % 2 == 0) budget.value = static_cast<double>(random() % 6);
        if (random() % 3 == 0) budget.image_de = static_cast<double>(random() % 3);
        Search search{chain, budget, {}, {}};
        search.step(0, chain.cheapest_cost_s, {});
        const auto made = plan(chain, budget);
        ASSERT_TRUE(made);
        ASSERT_EQ(made->meets_budget, search.least_cost_s.has_value());
        EXPECT_EQ(made->shortfall.empty(), made->meets_budget);
        if (made->meets_budget) {
            EXPECT_EQ(made->cost_s, *search.least_cost_s);
            ++met;
        } else {
            EXPECT_THAT(made->shortfall, HasSubstr("; set off: effect"));
            ++unmet;
        }
    }
    EXPECT_GT(met, 1000);
    EXPECT_GT(unmet, 50);
}

TEST(Planner, NoEffectIsOnThatCouldBeOff) {
    // If the plan meets a budget of errors, every lower rung of any step must break the budget or
    // save nothing.
    std::mt19937_64 random(4);
    for (int trial = 0; trial < 2000; ++trial) {
        const Chain chain = random_chain(random);
        Budget budget;
        budget.position_m = static_cast<double>(random() % 12);
        const auto made = plan(chain, budget);
        ASSERT_TRUE(made);
        if (!made->meets_budget) continue;
        for (std::size_t i = 0; i < chain.steps.size(); ++i) {
            double position_m = made->left_off.position_m;
            Choice lower = made->choice;
            for (std::size_t k = made->choice.rungs[i]; k > allowed_rungs(chain.steps[i]).least;
                 --k) {
                position_m += chain.steps[i].effects[k - 1].predicted.position_m;
                lower.rungs[i] = k - 1;
                const double saved_s = made->cost_s - cost_s(chain, lower);
                EXPECT_TRUE(position_m > *budget.position_m || saved_s <= 0);
            }
        }
    }
}

}  // namespace
}  // namespace stormcellar::accuracy
