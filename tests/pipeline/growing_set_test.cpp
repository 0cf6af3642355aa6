#include "pipeline/ingest/growing_set.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace stormcellar::pipeline {
namespace {

using std::chrono::milliseconds;
using std::chrono::minutes;
using std::chrono::seconds;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr std::uint64_t mib = std::uint64_t{1} << 20;

struct Thing {};

class GrowingSetTest : public ::testing::Test {
  protected:
    using Set = GrowingSet<std::string, Thing>;

    static GrowingLimits limits() {
        GrowingLimits limits;
        limits.count = 4;
        limits.station_count = 3;
        limits.held_bytes = 10 * mib;
        limits.station_held_bytes = 6 * mib;
        limits.shelf_bytes = 100 * mib;
        limits.station_shelf_bytes = 60 * mib;
        return limits;
    }
    bool add(const std::string& key, const std::string& station) {
        if (!set_.has_place(station, now_)) return false;
        set_.add(key, std::make_shared<Thing>(), station, now_);
        return true;
    }
    bool grow(const std::string& key, const std::string& station, const Growth& growth) {
        return set_.grew(key, set_.find(key).get(), station, growth, now_);
    }
    // Lets a member show that it continues: a sweep has closed, and more data came later.
    void let_go_on(const std::string& key, const std::string& station) {
        now_ += seconds{2};
        ASSERT_TRUE(grow(key, station, {.has_sweeps = true}));
    }

    Set set_{limits()};
    Set::Clock::time_point now_{};
};

TEST_F(GrowingSetTest, ANewcomerFindsNoPlaceOfItsStationWhileAllAreAlive) {
    for (const char* key : {"a", "b", "c"})
        ASSERT_TRUE(add(key, "KTLX"));
    EXPECT_FALSE(add("d", "KTLX"));
    EXPECT_TRUE(add("e", "KFWS")) << "each station has places of its own";
    now_ += Set::most_idle_at_first - milliseconds{1};
    EXPECT_FALSE(add("d", "KTLX"));
    now_ += milliseconds{1};
    EXPECT_TRUE(add("d", "KTLX"));
    EXPECT_THAT(set_.take_given_up(), ElementsAre("a"));
    EXPECT_THAT(set_.take_given_up(), IsEmpty());
}

TEST_F(GrowingSetTest, WhatGoesOnKeepsItsPlaceForAMinute) {
    for (const char* key : {"a", "b", "c"})
        ASSERT_TRUE(add(key, "KTLX"));
    let_go_on("a", "KTLX");
    now_ += Set::most_idle_at_first;
    ASSERT_TRUE(add("d", "KTLX"));
    ASSERT_TRUE(add("e", "KTLX"));
    EXPECT_THAT(set_.take_given_up(), ElementsAre("b", "c"));
    EXPECT_FALSE(add("f", "KTLX"))
        << "all members are active: a continues, and all other members have just begun";
    now_ += Set::most_idle - Set::most_idle_at_first;
    ASSERT_TRUE(grow("d", "KTLX", {}));
    ASSERT_TRUE(grow("e", "KTLX", {}));
    EXPECT_TRUE(add("f", "KTLX"));
    EXPECT_THAT(set_.take_given_up(), ElementsAre("a"));
}

TEST_F(GrowingSetTest, AtTheBoundOfAllTheStationThatHasMostGivesAPlace) {
    for (const char* key : {"a", "b", "c"})
        ASSERT_TRUE(add(key, "KTLX"));
    ASSERT_TRUE(add("d", "KFWS"));
    EXPECT_TRUE(add("e", "KINX"));
    EXPECT_THAT(set_.take_given_up(), ElementsAre("a"));
    // The stations now have two, one and one members. A new station may take a place from the first
    // station, but not from a station with one member.
    EXPECT_TRUE(add("f", "KVNX"));
    EXPECT_THAT(set_.take_given_up(), ElementsAre("b"));
    EXPECT_FALSE(add("g", "KAMA"));
    EXPECT_EQ(set_.count(), 4U);
}

TEST_F(GrowingSetTest, OfMemoryTheLargestOfTheStationGivesWay) {
    ASSERT_TRUE(add("small", "KTLX"));
    ASSERT_TRUE(add("large", "KTLX"));
    ASSERT_TRUE(grow("small", "KTLX", {.held_bytes = 2 * mib}));
    ASSERT_TRUE(grow("large", "KTLX", {.held_bytes = 4 * mib}))
        << "the size is just within the limit";
    EXPECT_EQ(set_.held_bytes(), 6 * mib);
    EXPECT_FALSE(grow("large", "KTLX", {.held_bytes = 4 * mib + 1}));
    EXPECT_THAT(set_.take_given_up(), ElementsAre("large"));
    EXPECT_EQ(set_.held_bytes(), 2 * mib);
}

TEST_F(GrowingSetTest, WhatStandsStillGivesWayBeforeWhatIsLargerAndAlive) {
    ASSERT_TRUE(add("idle", "KTLX"));
    ASSERT_TRUE(add("alive", "KTLX"));
    ASSERT_TRUE(grow("idle", "KTLX", {.held_bytes = 2 * mib}));
    now_ += minutes{3};
    EXPECT_TRUE(grow("alive", "KTLX", {.held_bytes = 5 * mib}));
    EXPECT_THAT(set_.take_given_up(), ElementsAre("idle"));
}

TEST_F(GrowingSetTest, AtTheBoundOfAllMemoryWhatNobodyKnowsGivesWayFirst) {
    ASSERT_TRUE(add("known", "KTLX"));
    ASSERT_TRUE(add("another", "KFWS"));
    ASSERT_TRUE(add("nobody", ""));
    ASSERT_TRUE(grow("nobody", "", {.held_bytes = 1 * mib}));
    ASSERT_TRUE(grow("known", "KTLX", {.held_bytes = 5 * mib}));
    ASSERT_TRUE(grow("another", "KFWS", {.held_bytes = 5 * mib}));
    EXPECT_THAT(set_.take_given_up(), ElementsAre("nobody"));
    EXPECT_LE(set_.held_bytes(), limits().held_bytes);
}

// Members without a closed sweep may together hold only a part of the memory.
TEST_F(GrowingSetTest, WhatHasClosedNoSweepHasABoundOfItsOwn) {
    GrowingLimits limits = GrowingSetTest::limits();
    limits.beginnings_held_bytes = 3 * mib;
    Set set{limits};
    const auto put = [&](const std::string& station, const Growth& growth) {
        if (!set.find(station)) set.add(station, std::make_shared<Thing>(), station, now_);
        return set.grew(station, set.find(station).get(), station, growth, now_);
    };
    ASSERT_TRUE(put("KTLX", {.held_bytes = 5 * mib, .has_sweeps = true}));
    ASSERT_TRUE(put("KFWS", {.held_bytes = 2 * mib}));
    EXPECT_FALSE(put("KINX", {.held_bytes = 2 * mib + 1}));
    EXPECT_THAT(set.take_given_up(), ElementsAre("KINX"));
    EXPECT_TRUE(put("KFWS", {.held_bytes = 4 * mib, .has_sweeps = true}))
        << "the limit does not apply after a sweep has closed";
    EXPECT_EQ(set.held_bytes(), 9 * mib);
}

TEST_F(GrowingSetTest, DiskIsBoundedByItself) {
    ASSERT_TRUE(add("a", "KTLX"));
    ASSERT_TRUE(add("b", "KTLX"));
    ASSERT_TRUE(grow("a", "KTLX", {.held_bytes = 3 * mib, .shelf_bytes = 20 * mib}));
    EXPECT_FALSE(grow("b", "KTLX", {.shelf_bytes = 41 * mib}));
    EXPECT_THAT(set_.take_given_up(), ElementsAre("b"));
    EXPECT_EQ(set_.shelf_bytes(), 20 * mib);
}

TEST_F(GrowingSetTest, OneThatWasReplacedDoesNotGrow) {
    ASSERT_TRUE(add("a", "KTLX"));
    const auto before = set_.find("a");
    set_.add("a", std::make_shared<Thing>(), "KTLX", now_);
    EXPECT_FALSE(set_.grew("a", before.get(), "KTLX", {.held_bytes = mib}, now_));
    EXPECT_EQ(set_.held_bytes(), 0U);
    set_.erase("a");
    EXPECT_EQ(set_.find("a"), nullptr);
    EXPECT_FALSE(set_.grew("a", before.get(), "KTLX", {}, now_));
}

TEST(GrowingLimits, MoreMomentsHoldMore) {
    const GrowingLimits one = GrowingLimits::of(1), all = GrowingLimits::of(6);
    EXPECT_EQ(one.held_bytes, 192 * mib);
    EXPECT_EQ(one.station_held_bytes, 16 * mib);
    EXPECT_GT(all.held_bytes, one.held_bytes);
    EXPECT_LT(all.station_held_bytes, all.held_bytes);
}

}  // namespace
}  // namespace stormcellar::pipeline
