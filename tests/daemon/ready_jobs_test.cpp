#include "daemon/queue/ready_jobs.h"

#include <array>
#include <map>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace stormcellar::daemon {
namespace {

class ReadyJobsTest : public ::testing::Test {
  protected:
    ReadyJobs::Key live(const std::string& station, std::int64_t newest_ns, bool begun = false) {
        return {Urgency::live, begun, newest_ns, next_++, station};
    }
    ReadyJobs::Key backlog(std::int64_t newest_ns, const std::string& station = {}) {
        return {Urgency::backlog, false, newest_ns, next_++, station};
    }
    ReadyJobs::Key add(const ReadyJobs::Key& key, const std::string& name) {
        jobs_.add(key, &names_.emplace(name, name).first->second);
        return key;
    }
    std::string next() {
        auto* name = static_cast<std::string*>(jobs_.take_next());
        return name == nullptr ? "" : *name;
    }
    std::string all() {
        std::string order;
        for (std::string name = next(); !name.empty(); name = next())
            order += (order.empty() ? "" : " ") + name;
        return order;
    }

    ReadyJobs jobs_;
    std::map<std::string, std::string> names_;
    std::uint64_t next_ = 0;
};

TEST_F(ReadyJobsTest, WhatIsLiveGoesBeforeTheBacklogWhichIsNewestFirst) {
    add(backlog(100), "newer");
    add(backlog(50), "older");
    add(backlog(50), "older-too");
    add(live("KTLX", 1), "live");
    EXPECT_EQ(all(), "live newer older older-too");
}

// Files that an event reported come before files that a scan found. Otherwise files that lost their
// places in the queue, and that each scan finds again, would delay new files.
TEST_F(ReadyJobsTest, WhatAnEventToldOfGoesBeforeWhatALookFound) {
    for (int i = 0; i < 10; ++i) {
        ReadyJobs::Key found = live("KAAA", 1000 + i);
        found.is_told = false;
        add(found, "found");
    }
    for (int i = 0; i < 10; ++i)
        add(live("KAAA", i), "told");
    EXPECT_EQ(all(),
              "told told told told found told told told told found told told "
              "found found found found found found found found");
}

// If live files always came first, files from before a restart would wait until a flood of live
// files ends.
TEST_F(ReadyJobsTest, TheBacklogOfKnownStationsDoesNotStandStill) {
    add(backlog(50, "KTLX"), "old");
    add(backlog(50), "others");
    for (int i = 0; i < 40; ++i)
        add(live("KAAA", 100 + i), "live");
    for (int i = 0; i < 16; ++i)
        ASSERT_EQ(next(), "live") << i;
    EXPECT_EQ(next(), "old");
    for (int i = 16; i < 40; ++i)
        ASSERT_EQ(next(), "live") << i;
    EXPECT_EQ(next(), "others");
}

TEST_F(ReadyJobsTest, StationsTakeTurnsHoweverMuchOneSends) {
    for (int i = 0; i < 4; ++i)
        add(live("KAAA", 10 + i), "a" + std::to_string(i));
    add(live("KBBB", 1), "b");
    add(live("KCCC", 1), "c0");
    add(live("KCCC", 2), "c1");
    EXPECT_EQ(all(), "a3 b c1 a2 c0 a1 a0");
}

TEST_F(ReadyJobsTest, AStationThatComesAgainWaitsForAllWhoWaited) {
    add(live("KAAA", 1), "a");
    add(live("KBBB", 1), "b");
    EXPECT_EQ(next(), "a");
    add(live("KAAA", 2), "a again");
    EXPECT_EQ(all(), "b a again");
}

TEST_F(ReadyJobsTest, WhatGoesOnWithAVolumeIsOldestFirstAndBeforeNewOnes) {
    add(live("KTLX", 30, true), "next volume's chunk");
    add(live("KTLX", 20, true), "end of the volume");
    add(live("KTLX", 99), "another file");
    EXPECT_EQ(all(), "end of the volume next volume's chunk another file");
}

TEST_F(ReadyJobsTest, AStationWhoseOnlyJobIsReplacedKeepsItsTurn) {
    const auto a = add(live("KAAA", 1), "a");
    add(live("KBBB", 1), "b");
    jobs_.replace(a, live("KAAA", 5), &names_["a"]);
    EXPECT_EQ(jobs_.count(), 2U);
    EXPECT_EQ(all(), "a b");
}

TEST_F(ReadyJobsTest, WhatIsRemovedDoesNotCome) {
    const auto a = add(live("KAAA", 1), "a");
    const auto old = add(backlog(3), "old");
    add(backlog(2), "older");
    jobs_.remove(a);
    jobs_.remove(old);
    jobs_.remove(a);
    EXPECT_EQ(jobs_.count(), 1U);
    EXPECT_EQ(all(), "older");
    EXPECT_TRUE(jobs_.empty());
    EXPECT_EQ(jobs_.take_next(), nullptr);
}

TEST_F(ReadyJobsTest, ClassesHaveTheirTurnsAndNoneStandsStill) {
    for (int i = 0; i < 20; ++i) {
        add(live("KTLX", i, true), "on" + std::to_string(i));
        add(live("KTLX", -i), "fresh" + std::to_string(i));
        add(live("", -i), "other" + std::to_string(i));
    }
    std::string kinds;
    for (int i = 0; i < 26; ++i)
        kinds += next().front();
    // eight jobs of "going on", four of "fresh", one of "others"
    const std::string round = "ooooooooffffo";
    EXPECT_EQ(kinds, round + round);
    EXPECT_EQ(next(), "on16") << "the next round begins";
}

TEST_F(ReadyJobsTest, NamesThatNobodyKnowsDelayNoKnownStation) {
    for (int i = 0; i < 50; ++i)
        add(live("", i), "flood");
    add(live("KTLX", 1), "a");
    add(live("KTLX", 2), "b");
    EXPECT_EQ(next(), "b");
    EXPECT_EQ(next(), "a");
    EXPECT_EQ(next(), "flood");
    add(live("KTLX", 3), "c");
    EXPECT_EQ(next(), "c");
}

TEST_F(ReadyJobsTest, TheBacklogOfKnownStationsGoesBeforeThatOfOthers) {
    add(backlog(100), "nobody's");
    add(backlog(50, "KTLX"), "old");
    add(backlog(60, "KOKX"), "newer");
    EXPECT_EQ(all(), "newer old nobody's");
}

TEST_F(ReadyJobsTest, WhoMayNotBeginIsPassedOver) {
    add(live("KTLX", 1), "a");
    add(live("KOKX", 1), "b");
    const auto not_the_first = [](const std::string& station) { return station != "KTLX"; };
    EXPECT_EQ(*static_cast<std::string*>(jobs_.take_next(not_the_first)), "b");
    EXPECT_EQ(jobs_.take_next(not_the_first), nullptr);
    EXPECT_EQ(next(), "a");
}

// In whatever order jobs come, no station may be served twice while another station waits.
TEST_F(ReadyJobsTest, NoStationIsServedTwiceWhileAnotherWaits) {
    std::mt19937 random(7);
    std::map<std::string, int> waiting;
    const std::array<std::string, 5> stations = {"KAAA", "KBBB", "KCCC", "KDDD", "KEEE"};
    std::map<std::string, int> passed;  // how often other stations were served while it waits
    for (const std::string& station : stations)
        passed[station] = 0;
    int served = 0;
    for (int step = 0; step < 5000; ++step) {
        if (random() % 2 == 0) {
            const std::string& station = stations.at(random() % 3 == 0 ? random() % 5 : 0);
            add(live(station, static_cast<std::int64_t>(random() % 100)), station);
            ++waiting[station];
            continue;
        }
        const std::string station = next();
        if (station.empty()) continue;
        ++served;
        --waiting[station];
        for (auto& [other, count] : passed) {
            if (other != station && waiting[other] > 0) ++count;
            ASSERT_LE(count, 4) << other;
        }
        passed[station] = 0;
        for (const std::string& other : stations)
            if (waiting[other] == 0) passed[other] = 0;
    }
    EXPECT_GT(served, 1000);
}

}  // namespace
}  // namespace stormcellar::daemon
