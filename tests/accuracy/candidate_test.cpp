#include "stormcellar/accuracy/candidate.h"

#include <algorithm>
#include <random>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/accuracy/infinity.h"
#include "tests/accuracy/small_chain.h"

namespace stormcellar::accuracy {
namespace {

using ::testing::HasSubstr;
using testing::random_chain;
using testing::small_chain;

template <class Change>
void change_effects(Chain& chain, Change change) {
    for (Step& step : chain.steps)
        std::for_each(step.effects.begin(), step.effects.end(), change);
}

TEST(Candidate, EachChoiceCostsAndLeavesOffWhatItSays) {
    const auto candidates = list_candidates(small_chain());
    ASSERT_TRUE(candidates);
    EXPECT_EQ(candidates->size(), 2U * 3 * 2);
    const Candidate& cheapest = candidates->front();
    EXPECT_EQ(cheapest.choice.rungs, (std::vector<std::size_t>{0, 0, 0}));
    EXPECT_EQ(cheapest.cost_s, 1);
    EXPECT_EQ(cheapest.left_off, (ErrorSize{470, 0.3, 0}));
    EXPECT_EQ(cheapest.off, 4U);
    EXPECT_EQ((*candidates)[1].choice.rungs, (std::vector<std::size_t>{0, 1, 0}));
    EXPECT_EQ((*candidates)[1].left_off, (ErrorSize{230, 0.3, 0}));
    EXPECT_EQ(candidates->back().off, 0U);
    EXPECT_EQ(candidates->back().left_off, ErrorSize{});
    EXPECT_DOUBLE_EQ(candidates->back().cost_s, 4.6);
}

TEST(Candidate, EffortGoesBeforeWhatWasMeasured) {
    Chain chain = small_chain();
    chain.steps[0].effects[0].effort = 1;  // its cost is 1 s
    chain.steps[1].effects[1].effort = 2;  // its cost is 2 s
    chain.steps[2].effects[0].effort = 3;  // its cost is 0.5 s
    const auto candidates = list_candidates(chain);
    ASSERT_TRUE(candidates);
    // Both {0, 1, 0} and {0, 0, 0} have no effort. {0, 0, 0} has one more effect off, so it comes
    // second. Measured costs do not count.
    EXPECT_EQ((*candidates)[0].choice.rungs, (std::vector<std::size_t>{0, 1, 0}));
    EXPECT_EQ((*candidates)[2].choice.rungs, (std::vector<std::size_t>{1, 1, 0}));
    EXPECT_EQ(candidates->back().effort, 6);
    for (std::size_t i = 1; i < candidates->size(); ++i)
        EXPECT_LE((*candidates)[i - 1].effort, (*candidates)[i].effort);
}

TEST(Candidate, TheOrderDoesNotHangOnWhatWasMeasuredWhereThereAreEfforts) {
    Chain chain = small_chain();
    change_effects(chain, [](Effect& effect) { effect.effort = 0.1; });
    const auto quiet = list_candidates(chain);
    double noise_s = 1;
    change_effects(chain, [&](Effect& effect) { effect.cost_s = noise_s = 3 / (1 + noise_s); });
    const auto busy = list_candidates(chain);
    ASSERT_TRUE(quiet && busy);
    for (std::size_t i = 0; i < quiet->size(); ++i)
        EXPECT_EQ((*quiet)[i].choice, (*busy)[i].choice) << i;
}

TEST(Candidate, WhatHasNoBoundIsNotLeftOffUnlessItIsSetSo) {
    Chain chain = small_chain();
    chain.steps[0].effects[0].predicted.value = infinity;
    const auto automatic = list_candidates(chain);
    ASSERT_TRUE(automatic);
    EXPECT_EQ(automatic->size(), 3U * 2);
    chain.steps[0].effects[0].setting = Setting::off;
    const auto set_off = list_candidates(chain);
    ASSERT_TRUE(set_off);
    EXPECT_EQ(set_off->size(), 3U * 2);
    EXPECT_EQ(set_off->front().choice.rungs[0], 0U);
}

TEST(Candidate, AtEqualCostTheMoreAccurateComesFirst) {
    Chain chain = small_chain();
    change_effects(chain, [](Effect& effect) { effect.cost_s = 0; });
    const auto candidates = list_candidates(chain);
    ASSERT_TRUE(candidates);
    EXPECT_EQ(candidates->front().off, 0U);
    EXPECT_EQ((*candidates)[1].choice.rungs, (std::vector<std::size_t>{1, 2, 0}));
    EXPECT_EQ((*candidates)[2].choice.rungs, (std::vector<std::size_t>{1, 1, 1}));
    EXPECT_EQ((*candidates)[3].choice.rungs, (std::vector<std::size_t>{0, 2, 1}));
}

TEST(Candidate, AllAllowedChoicesOnceAndNoOther) {
    std::mt19937_64 random(20261121);
    for (int trial = 0; trial < 500; ++trial) {
        const Chain chain = random_chain(random);
        const auto candidates = list_candidates(chain);
        ASSERT_TRUE(candidates);
        std::size_t expected = 1;
        for (const Step& step : chain.steps) {
            const RungRange range = allowed_rungs(step);
            expected *= range.most - range.least + 1;
        }
        std::set<std::vector<std::size_t>> seen;
        double cost_s = 0;
        for (const Candidate& candidate : *candidates) {
            EXPECT_TRUE(seen.insert(candidate.choice.rungs).second);
            EXPECT_GE(candidate.cost_s, cost_s);
            cost_s = candidate.cost_s;
            for (std::size_t i = 0; i < chain.steps.size(); ++i) {
                const auto& effects = chain.steps[i].effects;
                for (std::size_t k = 0; k < effects.size(); ++k) {
                    const bool on = k < candidate.choice.rungs[i];
                    EXPECT_FALSE(on && effects[k].setting == Setting::off);
                    EXPECT_FALSE(!on && effects[k].setting == Setting::on);
                }
            }
        }
        EXPECT_EQ(seen.size(), expected);
    }
}

TEST(Candidate, AChainOfNothingHasOneChoice) {
    const auto candidates = list_candidates(Chain{});
    ASSERT_TRUE(candidates);
    EXPECT_EQ(candidates->size(), 1U);
}

Chain wide_chain(int steps) {
    Chain chain;
    for (int i = 0; i < steps; ++i) {
        Effect effect;
        effect.name = "effect" + std::to_string(i);
        chain.steps.push_back({"step" + std::to_string(i), "cheap", {effect}});
    }
    return chain;
}

TEST(Candidate, TooManyChoicesAreRefusedUntilSettingsNarrowThem) {
    EXPECT_TRUE(list_candidates(wide_chain(16)));
    Chain chain = wide_chain(17);
    const auto refused = list_candidates(chain);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::unsupported);
    EXPECT_THAT(refused.error().message, HasSubstr("more than 65536 choices"));
    EXPECT_FALSE(list_candidates(wide_chain(1000)));  // the product must not overflow
    chain.steps[3].effects[0].setting = Setting::on;
    EXPECT_TRUE(list_candidates(chain));
}

TEST(Candidate, SharesAreOfTheTightestLimit) {
    Budget budget;
    budget.position_m = 200;
    budget.value = 0.5;
    EXPECT_EQ(worst_share({100, 0.1, 99}, budget), 0.5);
    EXPECT_EQ(worst_share({100, 1, 99}, budget), 2);
    EXPECT_EQ(worst_share({infinity, 0, 0}, budget), infinity);
    budget.position_m = 0;
    EXPECT_EQ(worst_share({0, 0.25, 0}, budget), 0.5);
    EXPECT_EQ(worst_share({1e-9, 0.25, 0}, budget), infinity);
    Budget time;
    time.time_s = 1;
    EXPECT_EQ(worst_share({125, 0.05, 0}, time), 0.5);
}

TEST(Candidate, TheLimitItselfIsWithin) {
    Budget budget;
    budget.position_m = 250;
    EXPECT_TRUE(within({250, 99, 99}, budget));
    EXPECT_FALSE(within({250.0001, 0, 0}, budget));
    budget.image_de = 0;
    EXPECT_FALSE(within({0, 0, 1e-300}, budget));
    EXPECT_TRUE(within({0, 0, 0}, budget));
}

}  // namespace
}  // namespace stormcellar::accuracy
