#include "stormcellar/base/station_rule.h"

#include <thread>

#include <gtest/gtest.h>

#include "stormcellar/base/station_table.h"

namespace stormcellar {
namespace {

TEST(StationRule, KnownIsTheTableAndWhatWasAdded) {
    StationRule rule;
    EXPECT_TRUE(rule.admits("KTLX"));
    EXPECT_TRUE(rule.knows("TOKC"));
    EXPECT_FALSE(rule.admits("XAAA"));
    EXPECT_FALSE(rule.admits(""));
    EXPECT_FALSE(rule.admits("ktlx"));
    set_added_stations({{"XAAA", "Somewhere", 10, 20, 30}});
    EXPECT_TRUE(rule.admits("XAAA"));
    const auto found = find_station("XAAA");
    ASSERT_TRUE(found);
    EXPECT_EQ(found->name, "Somewhere");
    EXPECT_EQ(found->latitude_deg, 10);
    EXPECT_EQ(found->longitude_deg, 20);
    EXPECT_EQ(found->antenna_altitude_m, 30);
    set_added_stations({});
    EXPECT_FALSE(rule.admits("XAAA"));
    EXPECT_FALSE(find_station("XAAA"));
}

TEST(StationRule, WhatTheTableHasStaysAsItIs) {
    set_added_stations({{"KTLX", "Elsewhere", 1, 2, 3}});
    EXPECT_EQ(find_station("KTLX")->name, "Oklahoma City");
    set_added_stations({});
}

TEST(StationRule, AnyAdmitsSoManyFurtherNamesAndRemembersThem) {
    StationRule rule = StationRule::any(2);
    EXPECT_FALSE(rule.knows("XAAA"));
    EXPECT_TRUE(rule.admits("XAAA"));
    EXPECT_TRUE(rule.knows("XAAA"));
    EXPECT_TRUE(rule.admits("XBBB"));
    EXPECT_FALSE(rule.admits("XCCC"));
    EXPECT_TRUE(rule.admits("XAAA"));
    EXPECT_TRUE(rule.admits("KTLX"));
    EXPECT_EQ(rule.further(), (std::vector<std::string>{"XAAA", "XBBB"}));
    EXPECT_FALSE(StationRule::any(9).admits("../x"));
    EXPECT_FALSE(StationRule::any(9).admits("X"));
}

TEST(StationRule, AListIsAllThereIs) {
    StationRule rule = StationRule::listed({"KTLX", "XAAA", "no name"});
    EXPECT_TRUE(rule.admits("KTLX"));
    EXPECT_TRUE(rule.admits("XAAA"));
    EXPECT_FALSE(rule.admits("KOKX"));
    EXPECT_FALSE(rule.admits("no name"));
    EXPECT_TRUE(rule.further().empty());
}

TEST(StationRule, TheSameRuleWhateverWasAdmitted) {
    StationRule rule = StationRule::any(2);
    EXPECT_TRUE(rule.admits("XAAA"));
    EXPECT_EQ(rule, StationRule::any(2));
    EXPECT_NE(rule, StationRule::any(3));
    EXPECT_NE(rule, StationRule{});
    EXPECT_NE(StationRule::listed({"KTLX"}), StationRule::listed({"KOKX"}));
    const StationRule copy = rule;
    EXPECT_TRUE(copy.knows("XAAA"));
}

TEST(StationRule, ThreadsAdmitNoMoreThanThereIsRoomFor) {
    StationRule rule = StationRule::any(10);
    std::vector<std::thread> threads;
    for (char first = 'A'; first < 'E'; ++first) {
        threads.emplace_back([&rule, first] {
            for (char last = 'A'; last <= 'Z'; ++last)
                (void)rule.admits(std::string{'X', first, 'Q', last});
        });
    }
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(rule.further().size(), 10U);
}

}  // namespace
}  // namespace stormcellar
