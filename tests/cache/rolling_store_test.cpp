// Tests the grids that a rolling store keeps and evicts, with real files. The test controls time
// and disk.
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cache/pins.h"
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
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::noon;

class RollingStoreTest : public ::testing::Test {
  protected:
    RollingStoreTest() {
        auto store = StoreWriter::open(disk_, directory_ / "one", false);
        EXPECT_TRUE(testing::commit_sized(*store, "A", noon));
        grid_bytes_ = testing::allocated_bytes(directory_ / "one");
    }
    RollingStore open(const Budgets& budgets) {
        Surroundings surroundings;
        surroundings.now = [this] { return now_; };
        surroundings.filling = [this](const fs::path&) -> Result<Filling> {
            return Filling{others_ + testing::allocated_bytes(cache_), capacity_};
        };
        auto store = RollingStore::open(disk_, cache_, budgets, surroundings);
        EXPECT_TRUE(store) << store.error().message;
        return std::move(*store);
    }
    // Returns a budget for `grids` grids of the usual size, plus the bytes by which a reservation
    // exceeds its file.
    [[nodiscard]] std::uint64_t room_for(int grids) const {
        return static_cast<std::uint64_t>(grids) * grid_bytes_ + 8 * 4096;
    }
    Result<fs::path> commit(StoreWriter& store, const std::string& domain, int minute) {
        return testing::commit_sized(store, domain, noon + minutes{minute});
    }
    static std::vector<std::string> grids(const StoreReader& store) {
        return testing::short_names(testing::all_grids(store));
    }
    [[nodiscard]] fs::path path(const std::string& domain, int minute) const {
        return cache_ /
               relative_path(GridName{domain, level2::Moment::ref, noon + minutes{minute}});
    }

    testing::TemporaryDirectory directory_;
    fs::path cache_ = directory_ / "cache";
    testing::MeteredFileSystem disk_{cache_};
    UtcTime now_ = noon + hours{24 * 30};
    std::uint64_t others_ = 0, capacity_ = 1'000'000'000;
    std::uint64_t grid_bytes_ = 0;
    Budgets budgets_;
};

TEST_F(RollingStoreTest, ACommitTakesTheRoomThatItNeedsAndARollTheRestDownToTheLowMark) {
    budgets_.total.bytes = room_for(10);
    budgets_.low_watermark = 0.5;
    RollingStore store = open(budgets_);
    for (int minute = 0; minute < 10; ++minute)
        ASSERT_TRUE(commit(store, "A", minute));
    EXPECT_EQ(store.roll().evicted, 0U) << "no limit is exceeded";
    ASSERT_TRUE(commit(store, "A", 10));
    EXPECT_EQ(grids(store).size(), 10U);
    EXPECT_EQ(grids(store).front(), "A+1");
    const RollReport report = store.roll();
    EXPECT_THAT(report.problems, IsEmpty());
    EXPECT_THAT(grids(store), ElementsAre("A+6", "A+7", "A+8", "A+9", "A+10"));
    EXPECT_EQ(report.evicted, 6U) << "the eviction by the commit counts, too";
    EXPECT_EQ(report.evicted_bytes, 6 * grid_bytes_);
    EXPECT_EQ(store.roll().evicted, 0U);
    EXPECT_EQ(store.usage().grids, 5U);
    EXPECT_EQ(store.usage().bytes, testing::allocated_bytes(cache_));
    EXPECT_EQ(store.usage().evicted, 6U);
    EXPECT_LE(disk_.most(), *budgets_.total.bytes);
}

// A roll calls `step` again and again, so that a watchdog does not take it for hung.
TEST_F(RollingStoreTest, ARollSaysThatItMovesOn) {
    budgets_.total.bytes = room_for(10);
    budgets_.low_watermark = 0.5;
    RollingStore store = open(budgets_);
    for (const char* domain : {"A", "B", "C"})
        ASSERT_TRUE(commit(store, domain, 0));
    int steps = 0;
    EXPECT_EQ(store.roll([&] { ++steps; }).evicted, 0U);
    EXPECT_GE(steps, 3) << "step is called for each directory";
}

TEST_F(RollingStoreTest, EachDomainHasItsOwnBudgetAndAllHaveOne) {
    budgets_.domains["A"].bytes = room_for(2);
    budgets_.total.bytes = room_for(5);
    budgets_.low_watermark = 1;
    RollingStore store = open(budgets_);
    for (const int minute : {1, 2, 3})
        ASSERT_TRUE(commit(store, "A", minute));
    EXPECT_THAT(grids(store), ElementsAre("A+2", "A+3"));
    for (const int minute : {4, 0, 5, 6})
        ASSERT_TRUE(commit(store, "B", minute));
    EXPECT_THAT(grids(store), ElementsAre("A+2", "A+3", "B+4", "B+5", "B+6"));
    ASSERT_TRUE(commit(store, "B", 7));
    EXPECT_THAT(grids(store), ElementsAre("A+3", "B+4", "B+5", "B+6", "B+7"));
    ASSERT_TRUE(commit(store, "B", 8));
    EXPECT_THAT(grids(store), ElementsAre("A+3", "B+5", "B+6", "B+7", "B+8"))
        << "the newest grid of A stays";
}

TEST_F(RollingStoreTest, AFullCacheDoesNotKeepWhatWouldBeTheFirstToGo) {
    budgets_.total.bytes = room_for(3);
    RollingStore store = open(budgets_);
    for (const int minute : {10, 11, 12})
        ASSERT_TRUE(commit(store, "A", minute));
    const auto old = commit(store, "A", 5);
    ASSERT_TRUE(old);
    EXPECT_TRUE(old->empty());
    EXPECT_FALSE(store.would_keep("A", level2::Moment::ref, noon + minutes{5}));
    EXPECT_TRUE(store.would_keep("A", level2::Moment::ref, noon + minutes{11}));
    EXPECT_TRUE(store.would_keep("B", level2::Moment::ref, noon + minutes{5}));
    EXPECT_THAT(grids(store), ElementsAre("A+10", "A+11", "A+12"));
    EXPECT_EQ(store.usage().not_kept, 1U);
    EXPECT_EQ(store.usage().evicted, 0U);
}

TEST_F(RollingStoreTest, TheNewestStaysUntilANewerStandsWhereTheBudgetHoldsTwo) {
    budgets_.total.bytes = room_for(2);
    RollingStore store = open(budgets_);
    ASSERT_TRUE(commit(store, "A", 1));
    disk_.set_capacity(grid_bytes_ + 8192);
    EXPECT_EQ(commit(store, "A", 2).error().code, ErrorCode::no_space);
    EXPECT_THAT(grids(store), ElementsAre("A+1"));
    disk_.set_capacity(capacity_);
    ASSERT_TRUE(commit(store, "A", 2));
    EXPECT_THAT(grids(store), ElementsAre("A+1", "A+2"));
    ASSERT_TRUE(commit(store, "A", 3));
    EXPECT_THAT(grids(store), ElementsAre("A+2", "A+3"));
}

TEST_F(RollingStoreTest, InABudgetOfOneGridTheNewestGivesWayToANewerOne) {
    budgets_.total.bytes = room_for(1);
    RollingStore store = open(budgets_);
    for (const int minute : {1, 2, 3})
        ASSERT_TRUE(commit(store, "A", minute));
    EXPECT_THAT(grids(store), ElementsAre("A+3"));
    EXPECT_TRUE(commit(store, "A", 2)->empty()) << "an older grid must not replace the newest";
    EXPECT_LE(disk_.most(), *budgets_.total.bytes);
}

TEST_F(RollingStoreTest, ABudgetBelowOneGridIsAnError) {
    budgets_.total.bytes = grid_bytes_ - 4096;
    RollingStore store = open(budgets_);
    const auto refused = commit(store, "A", 2);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::over_budget);
    EXPECT_TRUE(refused.error().message.starts_with(path("A", 2).native()))
        << refused.error().message;
    EXPECT_THAT(refused.error().message, HasSubstr("limits leave no room"));
    EXPECT_EQ(store.usage().bytes, 0U) << "the reservation was given back";

    Budgets larger = budgets_;
    larger.total.bytes = room_for(2);
    store.set_budgets(larger);
    ASSERT_TRUE(commit(store, "A", 2));
    ASSERT_TRUE(commit(store, "A", 3));
    EXPECT_THAT(grids(store), ElementsAre("A+2", "A+3"));
}

TEST_F(RollingStoreTest, OldAndNewOfAReplacedGridAreBothCounted) {
    budgets_.total.bytes = room_for(2);
    RollingStore store = open(budgets_);
    ASSERT_TRUE(commit(store, "A", 1));
    ASSERT_TRUE(commit(store, "A", 2));
    ASSERT_TRUE(commit(store, "A", 2)) << "replacing a grid evicts the other grid";
    EXPECT_THAT(grids(store), ElementsAre("A+2"));
    EXPECT_EQ(store.usage().bytes, grid_bytes_);
    EXPECT_LE(disk_.most(), *budgets_.total.bytes);
}

TEST_F(RollingStoreTest, WhatStandsAtTheStartIsBroughtWithinTheBudgetAndLeftoversAreSwept) {
    {
        auto store = *StoreWriter::open(disk_, cache_, false);
        for (int minute = 0; minute < 8; ++minute)
            ASSERT_TRUE(commit(store, "A", minute));
    }
    const fs::path leftover =
        path("A", 1).parent_path() / (std::string(temporary_prefix) + "4242-1");
    const fs::path above = cache_ / (std::string(temporary_prefix) + "ready-4242");
    for (const fs::path& file : {leftover, above})
        std::ofstream(file) << std::string(100'000, 'x');
    budgets_.total.bytes = room_for(4);
    budgets_.low_watermark = 0.99;
    RollingStore store = open(budgets_);
    EXPECT_FALSE(fs::exists(leftover));
    EXPECT_FALSE(fs::exists(above));
    EXPECT_THAT(grids(store), ElementsAre("A+4", "A+5", "A+6", "A+7"));
    EXPECT_EQ(store.usage().grids, 4U);
}

TEST_F(RollingStoreTest, AgeCountsFromTheNewestVolumeAndNotFromTheClock) {
    budgets_.total.age = hours{1};
    now_ = noon + hours{24 * 3650};
    RollingStore store = open(budgets_);
    for (const int minute : {0, 30, 60})
        ASSERT_TRUE(commit(store, "A", minute));
    ASSERT_TRUE(commit(store, "B", 0));
    EXPECT_EQ(store.roll().evicted, 0U);
    ASSERT_TRUE(commit(store, "A", 91));
    EXPECT_EQ(store.roll().evicted, 2U);
    EXPECT_THAT(grids(store), ElementsAre("A+60", "A+91", "B+0"));
    EXPECT_TRUE(commit(store, "A", 30)->empty()) << "the grid is older than the limit of age";
    EXPECT_FALSE(store.would_keep("A", level2::Moment::ref, noon + minutes{30}));
}

TEST_F(RollingStoreTest, AStampInTheFutureDoesNotEmptyTheCache) {
    budgets_.total.age = hours{1};
    now_ = std::chrono::floor<std::chrono::milliseconds>(std::chrono::system_clock::now());
    RollingStore store = open(budgets_);
    for (const int minute : {-90, -50, 0, 60 * 24 * 365})
        ASSERT_TRUE(testing::commit_sized(store, "A", now_ + minutes{minute}));
    store.roll();
    const auto all = testing::all_grids(store);
    ASSERT_EQ(all.size(), 3U)
        << "one grid is more than an hour older than the newest believable grid";
    EXPECT_EQ(all.front().time, now_ - minutes{50});
}

TEST_F(RollingStoreTest, GivesWayWhenOthersFillTheDisk) {
    budgets_.total.file_system_percent = 80;
    budgets_.low_watermark = 1;
    capacity_ = 10 * room_for(10);
    RollingStore store = open(budgets_);
    for (int minute = 0; minute < 10; ++minute)
        ASSERT_TRUE(commit(store, "A", minute));
    EXPECT_EQ(store.roll().evicted, 0U);
    others_ = capacity_ * 8 / 10 - 4 * grid_bytes_;
    const RollReport report = store.roll();
    EXPECT_EQ(report.evicted, 6U);
    EXPECT_THAT(report.problems, IsEmpty());
    EXPECT_EQ(grids(store).front(), "A+6");
    // Other programs fill the whole disk. The newest grid stays, and a problem is reported.
    others_ = capacity_;
    const RollReport last = store.roll();
    EXPECT_THAT(grids(store), ElementsAre("A+9"));
    EXPECT_THAT(last.problems, ElementsAre(HasSubstr("more than 80 % full")));
    ASSERT_TRUE(commit(store, "A", 10)) << "a new grid is always committed";
    store.roll();
    EXPECT_THAT(grids(store), ElementsAre("A+10"));
    others_ = 0;
    EXPECT_THAT(store.roll().problems, IsEmpty());
}

TEST_F(RollingStoreTest, TheLowMarkOfThePercentageIsAShareOfWhatTheCacheMayHold) {
    budgets_.total.file_system_percent = 50;
    budgets_.low_watermark = 0.5;
    capacity_ = 1'000'000'000;
    RollingStore store = open(budgets_);
    for (int minute = 0; minute < 10; ++minute)
        ASSERT_TRUE(commit(store, "A", minute));
    others_ = capacity_ / 2 - 8 * grid_bytes_;
    store.roll();
    EXPECT_EQ(grids(store).size(), 4U)
        << "the low mark is half of the room for 8 grids, not half of the disk";
}

TEST_F(RollingStoreTest, PinnedGridsStayAndCount) {
    budgets_.total.bytes = room_for(3);
    RollingStore store = open(budgets_);
    for (const int minute : {0, 1, 2})
        ASSERT_TRUE(commit(store, "A", minute));
    // The test sets the pin as another process would. The store notices the pin when it tries to
    // evict the grid.
    ASSERT_TRUE(pin_grid(real_file_system(), path("A", 0)));
    EXPECT_TRUE(testing::all_grids(store).front().pinned);
    for (const int minute : {3, 4})
        ASSERT_TRUE(commit(store, "A", minute));
    EXPECT_THAT(grids(store), ElementsAre("A+0", "A+3", "A+4"));
    EXPECT_EQ(store.usage().pinned, 1U);
    ASSERT_TRUE(commit(store, "A", 0)) << "the pinned grid can be replaced";
    EXPECT_THAT(grids(store), ElementsAre("A+0", "A+4"));
    ASSERT_TRUE(commit(store, "A", 5));

    ASSERT_TRUE(*unpin_grid(real_file_system(), path("A", 0)));
    EXPECT_FALSE(*unpin_grid(real_file_system(), path("A", 0)));
    store.roll();
    EXPECT_EQ(store.usage().pinned, 0U) << "a roll notices a removed pin";
    ASSERT_TRUE(commit(store, "A", 6));
    EXPECT_THAT(grids(store), ElementsAre("A+4", "A+5", "A+6"));
}

TEST_F(RollingStoreTest, APinNeedsAGrid) {
    RollingStore store = open(budgets_);
    EXPECT_EQ(pin_grid(real_file_system(), path("A", 0)).error().code, ErrorCode::not_found);
    ASSERT_TRUE(commit(store, "A", 1));
    EXPECT_EQ(pin_grid(real_file_system(), path("A", 0)).error().code, ErrorCode::not_found);
    EXPECT_TRUE(pin_grid(real_file_system(), path("A", 1)));
    EXPECT_TRUE(pin_grid(real_file_system(), path("A", 1))) << "pinning a pinned grid succeeds";
    EXPECT_EQ(*evict_grid(real_file_system(), path("A", 1)), Evicted::pinned);
    EXPECT_EQ(*evict_grid(real_file_system(), path("A", 0)), Evicted::missing);
}

TEST_F(RollingStoreTest, AllThatIsHeldPinnedIsAnErrorForTheNewest) {
    budgets_.total.bytes = room_for(2);
    RollingStore store = open(budgets_);
    for (const int minute : {0, 1})
        ASSERT_TRUE(commit(store, "A", minute));
    for (const int minute : {0, 1})
        ASSERT_TRUE(pin_grid(real_file_system(), path("A", minute)));
    const auto third = commit(store, "A", 2);
    ASSERT_FALSE(third);
    EXPECT_EQ(third.error().code, ErrorCode::over_budget);
    EXPECT_THAT(grids(store), ElementsAre("A+0", "A+1"));
    // After one pin is removed, the newest grid finds room, although the other grid stays pinned.
    ASSERT_TRUE(*unpin_grid(real_file_system(), path("A", 1)));
    store.roll();
    ASSERT_TRUE(commit(store, "A", 2));
    EXPECT_THAT(grids(store), ElementsAre("A+0", "A+2"));
}

TEST_F(RollingStoreTest, CountsWhatOthersRemovedAndAdded) {
    budgets_.total.bytes = room_for(4);
    RollingStore store = open(budgets_);
    for (int minute = 0; minute < 4; ++minute)
        ASSERT_TRUE(commit(store, "A", minute));
    fs::remove(path("A", 0));
    fs::remove(path("A", 1));
    store.roll();
    EXPECT_EQ(store.usage().grids, 2U);
    EXPECT_EQ(store.usage().bytes, testing::allocated_bytes(cache_));
    // There is room for these two grids without an eviction.
    for (const int minute : {4, 5})
        ASSERT_TRUE(commit(store, "A", minute));
    EXPECT_EQ(store.usage().evicted, 0U);
    fs::remove_all(cache_ / "A");
    store.roll();
    EXPECT_EQ(store.usage().bytes, 0U);
    ASSERT_TRUE(commit(store, "A", 6)) << "directories are made again";
    fs::copy_file(path("A", 6), directory_ / "copy");
    fs::remove_all(cache_);
    ASSERT_TRUE(commit(store, "A", 6)) << "the cache's directory is made again, too";
    EXPECT_THAT(grids(store), ElementsAre("A+6"));
}

TEST_F(RollingStoreTest, EmptyDirectoriesGo) {
    budgets_.total.bytes = room_for(2);
    RollingStore store = open(budgets_);
    for (int day = 0; day < 4; ++day)
        ASSERT_TRUE(commit(store, "A", day * 24 * 60));
    std::vector<std::string> days;
    for (const auto& entry : fs::directory_iterator(cache_ / "A/REF"))
        days.push_back(entry.path().filename());
    EXPECT_THAT(days, ::testing::UnorderedElementsAre("20241124", "20241125"));
}

TEST_F(RollingStoreTest, AReaderKeepsTheFileThatItHasOpen) {
    budgets_.total.bytes = room_for(2);
    RollingStore store = open(budgets_);
    ASSERT_TRUE(commit(store, "A", 0));
    const StoreEntry entry = testing::all_grids(store).front();
    const auto file = GridFile::open(entry.path);
    ASSERT_TRUE(file);
    for (int minute = 1; minute < 5; ++minute)
        ASSERT_TRUE(commit(store, "A", minute));
    ASSERT_FALSE(fs::exists(entry.path));
    EXPECT_TRUE(file->verify());
    EXPECT_EQ(grid::to_dense(file->view()).status,
              grid::to_dense(testing::sized_grid(4).view()).status);
}

TEST_F(RollingStoreTest, ASecondWriterIsRefusedAndReadersAreNot) {
    RollingStore store = open(budgets_);
    auto second = RollingStore::open(disk_, cache_, budgets_);
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().code, ErrorCode::busy);
    EXPECT_THAT(second.error().message, HasSubstr("another process writes to this cache"));
    EXPECT_TRUE(StoreReader::open(cache_));
}

TEST_F(RollingStoreTest, AnUnwrittenBudgetKeepsEverything) {
    RollingStore store = open(budgets_);
    for (int minute = 0; minute < 20; ++minute)
        ASSERT_TRUE(commit(store, "A", minute * 1000));
    EXPECT_EQ(store.roll().evicted, 0U);
    EXPECT_EQ(grids(store).size(), 20U);
}

}  // namespace
}  // namespace stormcellar::cache
