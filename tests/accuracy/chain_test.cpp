#include "stormcellar/accuracy/chain.h"

#include <limits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/accuracy/small_chain.h"

namespace stormcellar::accuracy {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::small_chain;

std::string error_of(const Chain& chain) {
    const auto valid = validate(chain);
    return valid ? "" : valid.error().message;
}

TEST(Chain, RungsAreNamedByTheirEffects) {
    const Chain chain = small_chain();
    EXPECT_EQ(error_of(chain), "");
    EXPECT_EQ(chain.steps[1].rung_count(), 3U);
    EXPECT_EQ(chain.steps[1].rung_name(0), "sphere");
    EXPECT_EQ(chain.steps[1].rung_name(2), "geodesic");
    EXPECT_EQ(describe(chain, {{1, 0, 1}}), "beam: ray traced, frame: sphere, averaging: linear Z");
    EXPECT_THAT(effect_names(chain),
                ElementsAre("refraction", "ellipsoid", "geodesic", "linear_mean"));
}

TEST(Chain, SettingsNarrowTheRungs) {
    Chain chain = small_chain();
    Step& frame = chain.steps[1];
    EXPECT_EQ(allowed_rungs(frame).least, 0U);
    EXPECT_EQ(allowed_rungs(frame).most, 2U);
    frame.effects[1].setting = Setting::off;
    EXPECT_EQ(allowed_rungs(frame).most, 1U);
    frame.effects[0].setting = Setting::on;
    EXPECT_EQ(allowed_rungs(frame).least, 1U);
    frame.effects[1].setting = Setting::on;  // requires the first effect
    frame.effects[0].setting = Setting::automatic;
    EXPECT_EQ(allowed_rungs(frame).least, 2U);
    frame.effects[1].setting = Setting::automatic;
    frame.effects[0].setting = Setting::off;  // required by the second effect
    EXPECT_EQ(allowed_rungs(frame).most, 0U);
}

TEST(Chain, WhatTheSceneDoesNotAskForIsNoErrorWhenLeftOff) {
    Chain chain = small_chain();
    const Choice none{{0, 0, 0}};
    const double all = left_off(chain, none).position_m;
    const double geodesic = chain.steps[1].effects[1].predicted.position_m;
    ASSERT_GT(geodesic, 0);
    chain.steps[1].effects[1].setting = Setting::not_asked;
    EXPECT_EQ(allowed_rungs(chain.steps[1]).most, 1U);
    EXPECT_NEAR(left_off(chain, none).position_m, all - geodesic, 1e-12 * all);
    EXPECT_THAT(exact_choice(chain).rungs, ElementsAre(1, 1, 1));
    // It is an error if an effect that is on requires an effect that is off.
    chain.steps[1].effects[1].setting = Setting::off;
    EXPECT_EQ(left_off(chain, none).position_m, all);
    EXPECT_THAT(exact_choice(chain).rungs, ElementsAre(1, 2, 1));
}

TEST(Chain, OverridesAreSetAllOrNone) {
    Chain chain = small_chain();
    const std::vector<EffectOverride> good = {{"refraction", Setting::on},
                                              {"geodesic", Setting::off}};
    ASSERT_TRUE(apply_overrides(chain, good));
    EXPECT_EQ(chain.steps[0].effects[0].setting, Setting::on);
    EXPECT_EQ(chain.steps[1].effects[1].setting, Setting::off);

    Chain untouched = small_chain();
    const std::vector<EffectOverride> against = {{"geodesic", Setting::on},
                                                 {"ellipsoid", Setting::off}};
    const auto refused = apply_overrides(untouched, against);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().message, "geodesic=on needs ellipsoid, which is off");
    EXPECT_EQ(untouched.steps[1].effects[0].setting, Setting::automatic);

    const std::vector<EffectOverride> twice = {{"geodesic", Setting::on},
                                               {"geodesic", Setting::on}};
    EXPECT_THAT(apply_overrides(untouched, twice).error().message, HasSubstr("set twice"));
    const std::vector<EffectOverride> unknown = {{"wind", Setting::on}};
    EXPECT_THAT(apply_overrides(untouched, unknown).error().message, HasSubstr("no effect"));
}

TEST(Chain, NumbersThatMakeNoSenseAreRefused) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    constexpr double infinity = std::numeric_limits<double>::infinity();
    for (const double size : {nan, -1.0, -0.0}) {
        Chain chain = small_chain();
        chain.steps[0].effects[0].predicted.value = size;
        EXPECT_THAT(error_of(chain), HasSubstr("refraction predicts a size")) << size;
    }
    for (const double cost_s : {nan, -1.0, infinity}) {
        Chain chain = small_chain();
        chain.steps[0].effects[0].cost_s = cost_s;
        EXPECT_THAT(error_of(chain), HasSubstr("refraction has a cost")) << cost_s;
        chain = small_chain();
        chain.cheapest_cost_s = cost_s;
        EXPECT_THAT(error_of(chain), HasSubstr("the chain has a cost")) << cost_s;
    }
    Chain chain = small_chain();
    chain.steps[0].effects[0].predicted.position_m = infinity;  // no bound is known
    EXPECT_EQ(error_of(chain), "");
}

TEST(Chain, JointCostsAddToThoseOfEachRung) {
    Chain chain = small_chain();
    EXPECT_DOUBLE_EQ(cost_s(chain, {{0, 0, 0}}), 1);
    EXPECT_DOUBLE_EQ(cost_s(chain, {{1, 2, 1}}), 4.6);
    chain.joint_costs = {{1, 2, 2, 1, 0.25}, {0, 1, 1, 1, -9}};
    EXPECT_EQ(error_of(chain), "");
    EXPECT_DOUBLE_EQ(cost_s(chain, {{1, 2, 0}}), 4.1) << "the joint cost needs both rungs";
    EXPECT_DOUBLE_EQ(cost_s(chain, {{1, 2, 1}}), 4.85);
    EXPECT_EQ(cost_s(chain, {{1, 1, 0}}), 0) << "a cost is never negative";
}

TEST(Chain, JointCostsOfNoTwoRungsAreRefused) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    for (const JointCost& joint :
         {JointCost{3, 0, 1, 1, 1}, JointCost{0, 2, 1, 1, 1}, JointCost{0, 1, 1, 3, 1},
          JointCost{1, 1, 1, 2, 1}, JointCost{0, 1, 1, 1, nan}}) {
        Chain chain = small_chain();
        chain.joint_costs = {joint};
        EXPECT_THAT(error_of(chain), HasSubstr("a joint cost does not belong to two rungs"));
    }
}

TEST(Chain, NamesAreNamesAndStandOnce) {
    Chain chain = small_chain();
    chain.steps[0].effects[0].name = "geodesic";
    EXPECT_THAT(error_of(chain), HasSubstr("geodesic is there twice"));
    chain.steps[0].effects[0].name = "No Name";
    EXPECT_THAT(error_of(chain), HasSubstr("\"No Name\""));
    chain = small_chain();
    chain.steps[2].name = "beam";
    EXPECT_THAT(error_of(chain), HasSubstr("\"beam\""));
}

TEST(Chain, StepsAreFoundByName) {
    const Chain chain = small_chain();
    for (std::size_t i = 0; i < chain.steps.size(); ++i) {
        EXPECT_EQ(find_step(chain, chain.steps[i].name), i);
        EXPECT_EQ(rung_of(chain, with_rung(exact_choice(chain), i, 0), chain.steps[i].name), 0U);
        EXPECT_EQ(rung_of(chain, exact_choice(chain), chain.steps[i].name),
                  exact_choice(chain).rungs[i]);
    }
    EXPECT_FALSE(find_step(chain, "no such step"));
    EXPECT_EQ(rung_of(chain, exact_choice(chain), "no such step"), 0U);
}

}  // namespace
}  // namespace stormcellar::accuracy
