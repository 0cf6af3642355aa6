#include "pipeline/ingest/followed.h"

#include <memory>
#include <string>

#include <gtest/gtest.h>

namespace stormcellar::pipeline {
namespace {

class FollowedTest : public ::testing::Test {
  protected:
    void add(const std::string& key) { set_.add(key, std::make_shared<int>(), "KTLX"); }

    Followed<std::string, int> set_{GrowingLimits{.station_held_bytes = 1000}};
};

TEST_F(FollowedTest, WhatIsGivenUpIsRememberedUntilItIsForgotten) {
    add("a");
    EXPECT_FALSE(set_.was_given_up("a"));
    set_.give_up("a");
    EXPECT_EQ(set_.find("a"), nullptr);
    EXPECT_TRUE(set_.was_given_up("a"));
    EXPECT_EQ(set_.take_given_up(), 1U);
    EXPECT_EQ(set_.take_given_up(), 0U) << "each key counts once";
    set_.forget("a");
    EXPECT_FALSE(set_.was_given_up("a"));
    set_.give_up("a");
    EXPECT_EQ(set_.take_given_up(), 0U) << "a key that is not followed cannot be given up";
}

TEST_F(FollowedTest, WhatGrowsBeyondItsBoundIsRememberedToo) {
    add("a");
    const auto a = set_.find("a");
    EXPECT_TRUE(set_.grew("a", a.get(), "KTLX", {.held_bytes = 900}));
    EXPECT_FALSE(set_.grew("a", a.get(), "KTLX", {.held_bytes = 1100}));
    EXPECT_TRUE(set_.was_given_up("a"));
    EXPECT_EQ(set_.take_given_up(), 1U);
}

TEST_F(FollowedTest, ASecondTryIsGivenOnceHoweverOftenItIsGivenUp) {
    EXPECT_FALSE(set_.take_second_try("a")) << "the key was never given up";
    add("a");
    set_.give_up("a");
    EXPECT_TRUE(set_.take_second_try("a"));
    EXPECT_FALSE(set_.take_second_try("a"));
    add("a");
    set_.give_up("a");
    EXPECT_FALSE(set_.take_second_try("a"));
    set_.forget("a");
    add("a");
    set_.give_up("a");
    EXPECT_TRUE(set_.take_second_try("a")) << "a forgotten key gets its second try again";
}

TEST_F(FollowedTest, TooManyAreForgottenTogether) {
    constexpr std::size_t most = Followed<std::string, int>::most_remembered;
    for (std::size_t i = 0; i < most; ++i) {
        add(std::to_string(i));
        set_.give_up(std::to_string(i));
    }
    EXPECT_TRUE(set_.was_given_up("0"));
    add("one more");
    set_.give_up("one more");
    EXPECT_FALSE(set_.was_given_up("0"));
    EXPECT_TRUE(set_.was_given_up("one more"));
    EXPECT_EQ(set_.take_given_up(), most + 1);
}

}  // namespace
}  // namespace stormcellar::pipeline
