// Grids of real volumes that are damaged or deleted, and made again.
#include "pipeline/mend_cache.h"

#include <fstream>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/testing/data.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::pipeline {
namespace {

namespace fs = std::filesystem;
using std::chrono::hours;
using std::chrono::minutes;

class MendCache : public ::testing::Test {
  protected:
    void SetUp() override { STORMCELLAR_NEED_DATA(); }

    void take_in(int volumes) {
        int taken = 0;
        for (const char* name :
             {"KBGM20050822_024414.gz", "KBGM20050822_025001.gz", "KBGM20050822_025549.gz"}) {
            if (taken++ == volumes) return;
            const fs::path raw = directory_ / name;
            fs::copy_file(*testing::data_directory() / "sequence-kbgm" / name, raw);
            const auto outcome = ingestor_.ingest(raw, false);
            ASSERT_TRUE(outcome) << outcome.error().message;
            ASSERT_EQ(outcome->result, IngestResult::gridded) << outcome->reason;
        }
    }
    std::vector<cache::StoreEntry> grids() {
        return *store_.list("KBGM", level2::Moment::ref, std::nullopt, std::nullopt);
    }
    void expect_all_good(std::size_t count) {
        EXPECT_EQ(grids().size(), count);
        for (const auto& grid : grids()) {
            const auto file = cache::GridFile::open(grid.path);
            ASSERT_TRUE(file) << file.error().message;
            EXPECT_TRUE(file->verify());
        }
    }
    static void alter_last_byte_of(const fs::path& path) {
        auto bytes = *read_file(path);
        bytes.back() ^= std::byte{1};
        std::ofstream(path, std::ios::binary | std::ios::trunc)
            .write(reinterpret_cast<const char*>(bytes.data()),
                   static_cast<std::streamsize>(bytes.size()));
    }
    static IngestOptions small_grid() {
        IngestOptions options;
        options.spacing_m = 4000;
        options.nx = options.ny = 115;
        return options;
    }
    testing::TemporaryDirectory directory_;
    catalog::Catalog catalog_ = *catalog::Catalog::open_for_writing(directory_ / "catalog");
    cache::Store store_ =
        *cache::Store::open_for_writing(real_file_system(), directory_ / "cache", true);
    Ingestor ingestor_{catalog_, store_, small_grid()};
    CacheMender mender_{catalog_, store_, ingestor_, level2::Moment::ref};
};

TEST_F(MendCache, AGridThatWasCutIsMadeAgainFromItsFile) {
    take_in(1);
    const auto grid = grids().at(0);
    const auto good = *read_file(grid.path);
    EXPECT_EQ(mender_.mend(grid, MendDepth::header)->condition, GridCondition::sound);
    fs::resize_file(grid.path, good.size() / 2);
    const auto mended = mender_.mend(grid, MendDepth::header);
    ASSERT_TRUE(mended) << mended.error().message;
    EXPECT_EQ(mended->condition, GridCondition::made_again);
    EXPECT_TRUE(mended->reason.starts_with(grid.path.native())) << mended->reason;
    EXPECT_EQ(mended->raw, directory_ / "KBGM20050822_024414.gz");
    EXPECT_EQ(*read_file(grid.path), good) << "to the byte";
    EXPECT_EQ(catalog_.list("KBGM", {})->at(0).state, catalog::FileState::complete);
}

TEST_F(MendCache, AnAlteredCodeIsFoundWhenAllIsRead) {
    take_in(1);
    const auto grid = grids().at(0);
    alter_last_byte_of(grid.path);
    EXPECT_EQ(mender_.mend(grid, MendDepth::header)->condition, GridCondition::sound);
    EXPECT_EQ(mender_.mend(grid, MendDepth::all)->condition, GridCondition::made_again);
    expect_all_good(1);
}

TEST_F(MendCache, ADamagedGridWithoutItsFileIsDropped) {
    take_in(2);
    fs::remove(directory_ / "KBGM20050822_024414.gz");
    std::ofstream(directory_ / "KBGM20050822_025001.gz", std::ios::app) << "changed since";
    for (const auto& grid : grids()) {
        fs::resize_file(grid.path, 4096);
        const auto mended = mender_.mend(grid, MendDepth::header);
        ASSERT_TRUE(mended);
        EXPECT_EQ(mended->condition, GridCondition::dropped);
        EXPECT_FALSE(fs::exists(grid.path));
    }
}

TEST_F(MendCache, AGridThatWasEvictedMeanwhileIsNoDamage) {
    take_in(1);
    const auto grid = grids().at(0);
    fs::remove(grid.path);
    EXPECT_EQ(mender_.mend(grid, MendDepth::all)->condition, GridCondition::sound);
    EXPECT_TRUE(grids().empty()) << "that is for missing() to decide";
}

TEST_F(MendCache, WhatIsOfALaterVersionIsLeftAlone) {
    take_in(1);
    const auto grid = grids().at(0);
    auto bytes = *read_file(grid.path);
    bytes[12] = std::byte{9};  // the version
    std::ofstream(grid.path, std::ios::binary | std::ios::trunc)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
    EXPECT_EQ(mender_.mend(grid, MendDepth::all)->condition, GridCondition::left_alone);
    EXPECT_TRUE(fs::exists(grid.path));
}

TEST_F(MendCache, AWipedCacheIsFilledNewestFirst) {
    take_in(3);
    fs::remove_all(directory_ / "cache/KBGM");
    const auto missing = mender_.missing(hours{6});
    ASSERT_TRUE(missing);
    ASSERT_EQ(missing->size(), 3U);
    EXPECT_GT(missing->at(0).time, missing->at(1).time);
    for (const MissingGrid& grid : *missing)
        EXPECT_EQ(mender_.make(grid)->result, IngestResult::gridded);
    expect_all_good(3);
    EXPECT_TRUE(mender_.missing(hours{6})->empty());
}

// The volumes lie six minutes apart.
TEST_F(MendCache, OnlyTheNewestOfAWipedCacheAreFilled) {
    take_in(3);
    fs::remove_all(directory_ / "cache/KBGM");
    EXPECT_EQ(mender_.missing(minutes{0})->size(), 1U);
    EXPECT_EQ(mender_.missing(minutes{7})->size(), 2U);
}

TEST_F(MendCache, WhatWasEvictedIsNotFilledInAgainAndAGapIs) {
    take_in(3);
    const auto all = grids();
    fs::remove(all[0].path);
    EXPECT_TRUE(mender_.missing(hours{6})->empty()) << "older than the oldest that stands";
    fs::remove(all[2].path);
    const auto missing = mender_.missing(hours{6});
    ASSERT_EQ(missing->size(), 1U);
    EXPECT_EQ(missing->at(0).time, all[2].time);
}

TEST_F(MendCache, FilesThatWentOrChangedAreNotTried) {
    take_in(2);
    fs::remove_all(directory_ / "cache/KBGM");
    fs::remove(directory_ / "KBGM20050822_024414.gz");
    std::ofstream(directory_ / "KBGM20050822_025001.gz", std::ios::app) << "more";
    EXPECT_TRUE(mender_.missing(hours{6})->empty());
}

}  // namespace
}  // namespace stormcellar::pipeline
