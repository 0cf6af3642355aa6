#include "stormcellar/cache/store.h"

#include <fstream>

#include <gtest/gtest.h>

#include "tests/cache/made_grids.h"
#include "tests/testing/power_cut_file_system.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::cache {
namespace {

namespace fs = std::filesystem;

class StoreTest : public ::testing::Test {
  protected:
    Result<fs::path> commit(StoreWriter& store, const std::string& domain, const char* time) {
        GridDescription about = describe(testing::small_grid());
        about.time = *parse_utc(time, UtcTime{});
        const auto bricks = grid::BrickGrid::from(testing::small_grid(), grid::Quantization{});
        return store.commit(domain, about, bricks.view());
    }
    testing::TemporaryDirectory directory_;
};

TEST_F(StoreTest, ListsWhatWasCommittedByTimeWithinInclusiveBounds) {
    auto store = StoreWriter::open(real_file_system(), directory_ / "c", false);
    ASSERT_TRUE(store);
    for (const char* time : {"2022-03-18T00:00", "2022-03-17T00:00:00.250Z", "2022-03-17T12:00"})
        ASSERT_TRUE(commit(*store, "KBGM", time));
    ASSERT_TRUE(commit(*store, "north-east", "2022-03-17T00:00"));

    EXPECT_EQ(*store->domains(), (std::vector<std::string>{"KBGM", "north-east"}));
    const auto all = *store->list("KBGM", level2::Moment::ref, std::nullopt, std::nullopt);
    ASSERT_EQ(all.size(), 3U);
    EXPECT_EQ(format_utc(all[0].time), "2022-03-17T00:00:00.250Z");
    EXPECT_TRUE(GridFile::open(all[0].path));
    EXPECT_GT(all[0].bytes_on_disk, 0U);
    const auto some = *store->list("KBGM", level2::Moment::ref, all[1].time, all[1].time);
    ASSERT_EQ(some.size(), 1U);
    EXPECT_EQ(some[0].path, all[1].path);
    EXPECT_TRUE(store->list("KBGM", level2::Moment::vel, std::nullopt, std::nullopt)->empty());
    EXPECT_TRUE(store->list("KTLX", level2::Moment::ref, std::nullopt, std::nullopt)->empty());
}

TEST_F(StoreTest, CommitOfTheSameTimeReplaces) {
    auto store = *StoreWriter::open(real_file_system(), directory_.path(), false);
    EXPECT_EQ(*commit(store, "KBGM", "2022-03-17T00:00"), *commit(store, "KBGM", "2022-03-17"));
    EXPECT_EQ(store.list("KBGM", level2::Moment::ref, std::nullopt, std::nullopt)->size(), 1U);
}

TEST_F(StoreTest, WhatNeedNotSurviveAPowerCutIsNotWaitedFor) {
    testing::PowerCutFileSystem files;
    auto store = *StoreWriter::open(files, directory_ / "c", false);
    ASSERT_TRUE(commit(store, "KBGM", "2022-03-17T00:00"));  // makes the directories
    GridDescription about = describe(testing::small_grid());
    about.time = *parse_utc("2022-03-17T00:05", UtcTime{});
    const auto bricks = grid::BrickGrid::from(testing::small_grid(), grid::Quantization{});
    const auto path = store.commit("KBGM", about, bricks.view(), Durability::until_a_crash);
    ASSERT_TRUE(path);
    const auto file = GridFile::open(*path);
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_TRUE(file->verify());
    files.power_cut();
    EXPECT_FALSE(GridFile::open(*path)) << "the file survived a power cut, so it was synced";
    EXPECT_EQ(
        store.list("KBGM", level2::Moment::ref, std::nullopt, about.time - std::chrono::minutes{1})
            ->size(),
        1U);
}

TEST_F(StoreTest, DomainNamesThatCouldLeaveTheStoreAreRefused) {
    auto store = *StoreWriter::open(real_file_system(), directory_.path(), false);
    for (const char* name : {"", "..", "../x", "a/b", "-x", ".hidden", "a b"}) {
        const auto path = commit(store, name, "2022-03-17");
        ASSERT_FALSE(path) << name;
        EXPECT_EQ(path.error().code, ErrorCode::bad_argument);
    }
    EXPECT_TRUE(fs::is_empty(directory_.path()));
}

TEST_F(StoreTest, SweepTakesOurLeftoversAndNothingElse) {
    auto store = *StoreWriter::open(real_file_system(), directory_.path(), false);
    const fs::path grid = *commit(store, "KBGM", "2022-03-17");
    const fs::path leftover = grid.parent_path() / (std::string{temporary_prefix} + "123-4");
    const fs::path foreign = grid.parent_path() / ".somebody-else";
    std::ofstream(leftover) << "half";
    std::ofstream(foreign) << "theirs";
    ASSERT_TRUE(StoreWriter::open(real_file_system(), directory_.path(), false));
    EXPECT_TRUE(fs::exists(leftover)) << "only the owner of the cache removes leftovers";
    ASSERT_TRUE(StoreWriter::open(real_file_system(), directory_.path(), true));
    EXPECT_FALSE(fs::exists(leftover));
    EXPECT_TRUE(fs::exists(foreign));
    EXPECT_TRUE(fs::exists(grid));
}

// A call that a reader or a writer does not offer must not compile.
template <class Store>
concept Commits = requires(Store& store, const GridDescription& about, const grid::BrickView& view,
                           const StoreEntry& entry) {
    store.commit("KBGM", about, view);
    store.remove(entry);
};
template <class Store>
concept Rolls = requires(Store& store) {
    store.roll();
    store.set_budgets(Budgets{});
};
static_assert(Commits<StoreWriter> && Commits<RollingStore>);
static_assert(!Commits<StoreReader> && !Commits<const StoreWriter>);
static_assert(Rolls<RollingStore>);
static_assert(!Rolls<StoreWriter> && !Rolls<const RollingStore>);

TEST_F(StoreTest, ReadersNeedADirectory) {
    EXPECT_EQ(StoreReader::open(directory_ / "no").error().code, ErrorCode::not_found);
    const auto store = *StoreReader::open(directory_.path());
    EXPECT_TRUE(store.domains()->empty());
}

TEST_F(StoreTest, CommittedGridSurvivesAPowerCutWithItsDirectories) {
    testing::PowerCutFileSystem file_system;
    auto store = *StoreWriter::open(file_system, directory_ / "c", false);
    const auto path = commit(store, "KBGM", "2022-03-17");
    ASSERT_TRUE(path);
    file_system.power_cut();
    const auto file = GridFile::open(*path);
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_TRUE(file->verify());
}

}  // namespace
}  // namespace stormcellar::cache
