// Tests a disk that is full although the budgets have room, because other programs took the space.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stormcellar/cache/store.h"
#include "tests/cache/made_grids.h"
#include "tests/testing/metered_file_system.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::cache {
namespace {

namespace fs = std::filesystem;
using std::chrono::minutes;
using ::testing::HasSubstr;
using testing::noon;

class FullDiskTest : public ::testing::Test {
  protected:
    RollingStore open(const Budgets& budgets) {
        return *RollingStore::open(disk_, cache_, budgets);
    }
    auto commit(StoreWriter& store, int minute) {
        return testing::commit_sized(store, "A", noon + minutes{minute});
    }
    testing::TemporaryDirectory directory_;
    fs::path cache_ = directory_ / "cache";
    testing::MeteredFileSystem disk_{cache_};
    Budgets budgets_;
};

TEST_F(FullDiskTest, TheOldestMakeRoomWhereABudgetLimitsSpace) {
    budgets_.total.bytes = 1'000'000'000;
    RollingStore store = open(budgets_);
    for (int minute = 0; minute < 8; ++minute)
        ASSERT_TRUE(commit(store, minute));
    disk_.set_capacity(testing::allocated_bytes(cache_) + 4096);
    for (int minute = 8; minute < 20; ++minute)
        ASSERT_TRUE(commit(store, minute)) << minute;
    const auto grids = testing::all_grids(store);
    EXPECT_EQ(grids.back().time, noon + minutes{19});
    EXPECT_GE(grids.size(), 6U);
    for (const StoreEntry& entry : grids)
        EXPECT_EQ(testing::trouble_in(entry), "");
    EXPECT_EQ(store.usage().bytes, testing::allocated_bytes(cache_));
}

TEST_F(FullDiskTest, WithoutSuchABudgetItIsAClearErrorAndNothingIsHalfWritten) {
    budgets_.total.age = std::chrono::hours{1000};
    RollingStore store = open(budgets_);
    for (int minute = 0; minute < 4; ++minute)
        ASSERT_TRUE(commit(store, minute));
    const std::uint64_t before = testing::allocated_bytes(cache_);
    disk_.set_capacity(before + 8192);
    const auto refused = commit(store, 4);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::no_space);
    EXPECT_THAT(refused.error().message, HasSubstr("A_REF_20241122_120400_000.scg"));
    EXPECT_THAT(refused.error().message, HasSubstr("No space left on device"));
    EXPECT_EQ(testing::all_grids(store).size(), 4U);
    EXPECT_EQ(testing::allocated_bytes(cache_), before);
    EXPECT_EQ(store.usage().bytes, before);
}

TEST_F(FullDiskTest, WhenNothingMayGoItIsAnErrorToo) {
    budgets_.total.file_system_percent = 90;
    RollingStore store = open(budgets_);
    ASSERT_TRUE(commit(store, 0));
    disk_.set_capacity(testing::allocated_bytes(cache_) + 4096);
    const auto refused = commit(store, 1);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::no_space);
    EXPECT_EQ(testing::all_grids(store).size(), 1U) << "the newest grid stays";
}

// After the error no_space, the daemon ingests no files of any station. So a grid of an unknown
// station must not give this error while known stations can still get room by eviction.
TEST_F(FullDiskTest, AGridOfAStationThatNobodyKnowsIsNotKeptAndTakesNothing) {
    budgets_.total.bytes = 1'000'000'000;
    RollingStore store = open(budgets_);
    for (int minute = 0; minute < 8; ++minute)
        ASSERT_TRUE(commit(store, minute));
    const std::uint64_t before = testing::allocated_bytes(cache_);
    disk_.set_capacity(before + 4096);
    const auto path = testing::commit_sized(store, "XAAA", noon + minutes{100});
    ASSERT_TRUE(path) << path.error().message;
    EXPECT_TRUE(path->empty());
    EXPECT_EQ(testing::all_grids(store).size(), 8U);
    EXPECT_EQ(testing::allocated_bytes(cache_), before);
    EXPECT_EQ(store.usage().bytes, before);
    EXPECT_EQ(store.usage().not_kept, 1U);
    ASSERT_TRUE(commit(store, 9)) << "a known grid replaces the oldest grid";
}

// A file system that cannot finish or remove files while `broken` is set.
class Unremovable final : public FileSystem {
  public:
    Result<int> create_exclusive(const fs::path& path) override {
        return real_file_system().create_exclusive(path);
    }
    Status write_at(int descriptor, std::uint64_t offset,
                    std::span<const std::byte> bytes) override {
        if (broken && offset > 0) return fail(ErrorCode::io, "write: Input/output error");
        return real_file_system().write_at(descriptor, offset, bytes);
    }
    Status set_size(int descriptor, std::uint64_t size) override {
        return real_file_system().set_size(descriptor, size);
    }
    Status sync(int) override { return {}; }
    void close(int descriptor) override { real_file_system().close(descriptor); }
    Status rename(const fs::path& from, const fs::path& to) override {
        return real_file_system().rename(from, to);
    }
    Status sync_directory(const fs::path&) override { return {}; }
    Status remove(const fs::path& path) override {
        if (broken) return fail(ErrorCode::io, "{}: Input/output error", path.native());
        return real_file_system().remove(path);
    }
    bool broken = false;
};

TEST_F(FullDiskTest, WhatABrokenDiskLeavesBehindIsCounted) {
    Unremovable disk;
    budgets_.total.bytes = 1'000'000'000;
    RollingStore store = *RollingStore::open(disk, cache_, budgets_);
    for (int minute = 0; minute < 3; ++minute)
        ASSERT_TRUE(commit(store, minute));
    disk.broken = true;
    EXPECT_EQ(commit(store, 3).error().code, ErrorCode::io);
    EXPECT_GT(testing::allocated_bytes(cache_), 0U);
    EXPECT_EQ(store.usage().bytes, testing::allocated_bytes(cache_));
    Budgets smaller;
    smaller.total.bytes = 100;
    store.set_budgets(smaller);
    const RollReport report = store.roll();
    EXPECT_THAT(report.problems, ::testing::Contains(HasSubstr("cannot evict: ")));
    EXPECT_THAT(report.problems, ::testing::Contains(HasSubstr("more than its limit")));
    EXPECT_EQ(store.usage().bytes, testing::allocated_bytes(cache_));
    store.set_budgets(budgets_);
    disk.broken = false;
    store.roll();
    EXPECT_EQ(testing::all_grids(store).size(), 3U);
    EXPECT_EQ(std::distance(fs::directory_iterator(cache_ / "A/REF/20241122"), {}), 3);
    EXPECT_EQ(store.usage().bytes, testing::allocated_bytes(cache_));
}

}  // namespace
}  // namespace stormcellar::cache
