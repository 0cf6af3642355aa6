// Tests with real files that grids of unknown stations displace no grids of known stations, and do
// not stay.
#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cache/pins.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/cache/store.h"
#include "tests/cache/made_grids.h"
#include "tests/testing/metered_file_system.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::cache {
namespace {

namespace fs = std::filesystem;
using std::chrono::hours;
using std::chrono::minutes;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::noon;

// Returns a name that no table of stations has: XAAA for 0, XAAB for 1, ...
std::string invented(int number) {
    std::string name = "XAAA";
    for (std::size_t at = 3; at > 0; --at, number /= 26)
        name[at] = static_cast<char>('A' + number % 26);
    return name;
}

class OthersGridsTest : public ::testing::Test {
  protected:
    RollingStore open(const fs::path& cache, const Budgets& budgets) {
        Surroundings surroundings;
        surroundings.now = [this] { return now_utc() + later_; };
        surroundings.filling = [this](const fs::path& directory) -> Result<Filling> {
            return Filling{beside_ + testing::allocated_bytes(directory), capacity_};
        };
        auto store = RollingStore::open(real_file_system(), cache, budgets, surroundings);
        EXPECT_TRUE(store) << store.error().message;
        return std::move(*store);
    }
    static Result<fs::path> commit(StoreWriter& store, const std::string& domain, int minute,
                                   int stored = 4) {
        return testing::commit_sized(store, domain, noon + minutes{minute}, stored);
    }
    static std::vector<std::string> grids_of(const StoreReader& store, bool known) {
        std::vector<std::string> names;
        for (const StoreEntry& entry : testing::all_grids(store))
            if (is_known_group(entry.domain) == known) names.push_back(entry.path.filename());
        return names;
    }
    static std::uint64_t bytes_of_others(const StoreReader& store) {
        std::uint64_t bytes = 0;
        for (const StoreEntry& entry : testing::all_grids(store))
            if (!is_known_group(entry.domain)) bytes += entry.bytes_on_disk;
        return bytes;
    }
    // Leaves the newest grids of `count` invented stations in the cache, as an older version did.
    void leave_behind(int count) {
        auto store = *StoreWriter::open(real_file_system(), cache_, false);
        for (int site = 0; site < count; ++site)
            ASSERT_TRUE(commit(store, invented(site), site));
    }
    testing::TemporaryDirectory directory_;
    fs::path cache_ = directory_ / "cache";
    hours later_{0};
    std::uint64_t beside_ = 0, capacity_ = 100'000'000'000;
    Budgets budgets_;
};

// 2026-11-24: 200 invented stations filled a cache of 20 MB with "newest" grids, which were never
// removed. Real grids were evicted for them, and new real grids were refused.
TEST_F(OthersGridsTest, TwoHundredInventedStationsTakeNothingFromThoseThatAreKnown) {
    budgets_.total.bytes = 20'000'000;
    RollingStore attacked = open(cache_, budgets_);
    RollingStore quiet = open(directory_ / "quiet", budgets_);
    for (int site = 0; site < 200; ++site)
        ASSERT_TRUE(commit(attacked, invented(site), site));
    EXPECT_LE(bytes_of_others(attacked), 2'000'000U);
    EXPECT_GT(bytes_of_others(attacked), 1'000'000U);

    const std::vector<std::string> real = {"KTLX", "KINX", "northeast", "northeast.KBOX"};
    for (int step = 0; step < 360; ++step) {
        const std::string& domain = real[static_cast<std::size_t>(step) % real.size()];
        for (RollingStore* store : {&attacked, &quiet}) {
            const auto path = commit(*store, domain, step, 5 + step % 4);
            ASSERT_TRUE(path) << path.error().message;
            ASSERT_FALSE(path->empty());
        }
        const auto others = commit(attacked, invented(step % 200), 10'000 + step, 1 + step % 8);
        ASSERT_TRUE(others) << others.error().message;
        if (step % 30 == 29) {
            attacked.roll();
            quiet.roll();
            ASSERT_EQ(grids_of(attacked, true), grids_of(quiet, true)) << step;
        }
    }
    EXPECT_GT(quiet.usage().evicted, 0U) << "the real stations never filled the cache";
    EXPECT_LE(bytes_of_others(attacked), 2'000'000U);
    EXPECT_LE(testing::allocated_bytes(cache_), *budgets_.total.bytes);
    EXPECT_GT(attacked.usage().not_kept, 0U);

    later_ = hours{169};
    attacked.roll();
    EXPECT_THAT(grids_of(attacked, false), IsEmpty());
}

// The newest grids of known stations together exceed the budget.
TEST_F(OthersGridsTest, KnownStationsFindRoomEvenWhereTheirNewestAloneExceedTheBudget) {
    budgets_.total.bytes = 1'500'000;
    RollingStore store = open(cache_, budgets_);
    for (int round = 0; round < 2; ++round) {
        for (const Station& station : all_stations().subspan(0, 80)) {
            const auto path = commit(store, std::string(station.icao), round, 1 + round * 3);
            ASSERT_TRUE(path) << path.error().message;
            ASSERT_TRUE(fs::exists(*path)) << *path;
        }
        EXPECT_THAT(store.roll().problems, IsEmpty());
    }
    // Each grid is large. In the smaller budget, one grid takes nearly all of the room.
    ASSERT_TRUE(commit(store, "KTLX", 10, 8));
    ASSERT_TRUE(commit(store, "KTLX", 11, 8));
    Budgets small = budgets_;
    small.total.bytes = 120'000;
    store.set_budgets(small);
    ASSERT_TRUE(commit(store, "KTLX", 12, 8));
    ASSERT_TRUE(commit(store, "KTLX", 13, 8));
    ASSERT_TRUE(commit(store, "KINX", 13, 8));
    EXPECT_LE(testing::allocated_bytes(cache_), *small.total.bytes);
    EXPECT_THAT(store.roll().problems, IsEmpty());
}

TEST_F(OthersGridsTest, WhatAnAttackLeftGoesWhenItIsOld) {
    leave_behind(40);
    budgets_.total.bytes = 1'000'000'000;
    RollingStore store = open(cache_, budgets_);
    EXPECT_EQ(grids_of(store, false).size(), 40U)
        << "the grids are within the share of others, and young";
    const StoreEntry kept = testing::all_grids(store).front();
    ASSERT_TRUE(pin_grid(real_file_system(), kept.path));
    ASSERT_TRUE(commit(store, "KTLX", 0));
    later_ = hours{167};
    EXPECT_EQ(store.roll().evicted, 0U);
    later_ = hours{169};
    EXPECT_EQ(store.roll().evicted, 39U);
    EXPECT_EQ(testing::all_grids(store).size(), 2U)
        << "the pinned grid and the known station's grid stay";
    EXPECT_FALSE(fs::exists(cache_ / invented(1))) << "empty directories are removed";
}

TEST_F(OthersGridsTest, TheyGoByAgeWithoutAnyBudget) {
    leave_behind(3);
    later_ = hours{169};
    RollingStore store = open(cache_, budgets_);
    EXPECT_THAT(testing::all_grids(store), IsEmpty());
}

TEST_F(OthersGridsTest, WhatAnAttackLeftIsBroughtDownToItsShareAtTheStart) {
    leave_behind(50);
    const std::uint64_t left = testing::allocated_bytes(cache_);
    budgets_.total.bytes = left;  // the cache is full
    RollingStore store = open(cache_, budgets_);
    EXPECT_LE(bytes_of_others(store), left / 10);
    EXPECT_GT(bytes_of_others(store), 0U);
    EXPECT_FALSE(grids_of(store, false).empty());
    EXPECT_EQ(grids_of(store, false).back().substr(0, 4), invented(49))
        << "the oldest grids of others were evicted";
}

TEST_F(OthersGridsTest, AFullFileSystemTakesTheirsFirst) {
    budgets_.total.file_system_percent = 80;
    budgets_.low_watermark = 0.5;
    RollingStore store = open(cache_, budgets_);
    for (int minute = 0; minute < 10; ++minute)
        ASSERT_TRUE(commit(store, "KTLX", minute));
    const std::uint64_t of_known = testing::allocated_bytes(cache_);
    for (int site = 0; site < 5; ++site)
        ASSERT_TRUE(commit(store, invented(site), 100 + site));
    // The cache exceeds its limit by one block of the disk. Without the rule for others, known
    // grids would also be evicted, down to the low mark at which eviction stops.
    beside_ = capacity_ * 8 / 10 - testing::allocated_bytes(cache_) + 4096;
    EXPECT_EQ(store.roll().evicted, 5U);
    EXPECT_EQ(testing::allocated_bytes(cache_), of_known)
        << "no known grid was evicted for grids of others";
    // If known grids alone exceed the limit, at most half of the space is protected.
    ASSERT_TRUE(commit(store, "KINX", 0));
    beside_ = 0;
    capacity_ = of_known / 10 * 3;
    EXPECT_THAT(store.roll().problems, IsEmpty());
    ASSERT_EQ(grids_of(store, true).size(), 1U);
    EXPECT_EQ(grids_of(store, true).front().substr(0, 4), "KTLX");
}

TEST_F(OthersGridsTest, TheirShareOfAFileSystemIsKept) {
    budgets_.total.file_system_percent = 50;
    capacity_ = 8'000'000;
    RollingStore store = open(cache_, budgets_);
    for (int site = 0; site < 30; ++site)
        ASSERT_TRUE(commit(store, invented(site), site));
    EXPECT_LE(bytes_of_others(store), 400'000U);
    EXPECT_GT(bytes_of_others(store), 300'000U);
}

TEST_F(OthersGridsTest, TheOpenerSaysWhoIsKnown) {
    budgets_.total.bytes = 1'000'000;
    std::string known = "XAAA";
    Surroundings surroundings;
    surroundings.is_known = [&](std::string_view group) { return group == known; };
    auto store = RollingStore::open(real_file_system(), cache_, budgets_, surroundings);
    ASSERT_TRUE(store);
    for (int minute = 0; minute < 10; ++minute) {
        ASSERT_TRUE(commit(*store, "XAAA", minute));
        ASSERT_TRUE(commit(*store, "KTLX", minute));
    }
    const auto count = [&](const char* domain) {
        return store->list(domain, level2::Moment::ref, {}, {})->size();
    };
    EXPECT_EQ(count("XAAA"), 10U);
    EXPECT_LE(count("KTLX"), 2U);
    known = "KTLX";
    store->roll();
    EXPECT_LE(count("XAAA"), 2U);
    for (int minute = 20; minute < 30; ++minute)
        ASSERT_TRUE(commit(*store, "KTLX", minute));
    EXPECT_GE(count("KTLX"), 10U);
}

}  // namespace
}  // namespace stormcellar::cache
