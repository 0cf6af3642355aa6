#include "stormcellar/accuracy/plan.h"

#include <map>

#include <gtest/gtest.h>

#include "stormcellar/accuracy/planner.h"
#include "tests/accuracy/small_chain.h"

namespace stormcellar::accuracy {
namespace {

using testing::small_chain;

std::map<std::string, Decision> decisions_of(const Chain& chain, const char* budget) {
    const auto made = plan(chain, parse_budget(budget).value());
    EXPECT_TRUE(made);
    std::map<std::string, Decision> decisions;
    for (const Decision& decision : made->decisions)
        decisions[decision.effect] = decision;
    return decisions;
}

TEST(Plan, EveryEffectIsDecidedAndSaysWhy) {
    auto decisions = decisions_of(small_chain(), "250 m, 0.5 dB");
    ASSERT_EQ(decisions.size(), 4U);
    EXPECT_FALSE(decisions["refraction"].on);
    EXPECT_EQ(decisions["refraction"].reason, "small: all that is left off is within the budget");
    EXPECT_EQ(decisions["refraction"].share, 0.8);
    EXPECT_EQ(decisions["refraction"].step, "beam");
    EXPECT_EQ(decisions["refraction"].evidence, Evidence::proven_bound);
    EXPECT_TRUE(decisions["ellipsoid"].on);
    EXPECT_EQ(decisions["ellipsoid"].reason,
              "without it 470 m would be left off, of 250 m allowed");
    EXPECT_EQ(decisions["linear_mean"].share, 0.6);
}

TEST(Plan, SettingsAreNamedAsReasons) {
    Chain chain = small_chain();
    chain.steps[0].effects[0].setting = Setting::off;
    chain.steps[1].effects[1].setting = Setting::on;
    auto decisions = decisions_of(chain, "250 m");
    EXPECT_EQ(decisions["refraction"].reason, "set off");
    EXPECT_EQ(decisions["geodesic"].reason, "set on");
    EXPECT_EQ(decisions["ellipsoid"].reason, "geodesic needs it, which is set on");
    chain = small_chain();
    chain.steps[1].effects[0].setting = Setting::off;
    decisions = decisions_of(chain, "250 m");
    EXPECT_EQ(decisions["geodesic"].reason, "needs ellipsoid, which is set off");
    EXPECT_EQ(decisions["refraction"].reason,
              "without it 470 m would be left off, of 250 m allowed");
}

TEST(Plan, WhatChangesNothingOrCostsNothingSaysSo) {
    Chain chain = small_chain();
    chain.steps[0].effects[0].predicted = {};
    chain.steps[2].effects[0].cost_s = 0;
    auto decisions = decisions_of(chain, "250 m, 0.5 dB");
    EXPECT_EQ(decisions["refraction"].reason, "changes nothing here");
    EXPECT_EQ(decisions["linear_mean"].reason, "costs nothing");
}

TEST(Plan, ATimeHasRoomForSome) {
    auto decisions = decisions_of(small_chain(), "2.2 s");
    EXPECT_EQ(decisions["refraction"].reason, "there is time for it");
    EXPECT_EQ(decisions["geodesic"].reason, "there is no time for it");
}

}  // namespace
}  // namespace stormcellar::accuracy
