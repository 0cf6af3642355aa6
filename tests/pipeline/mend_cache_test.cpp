// Tests that damaged or deleted grids of real volumes are made again.
#include "pipeline/care/mend_cache.h"

#include <fstream>
#include <map>

#include <fmt/chrono.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/pipeline/small_domain.h"
#include "tests/pipeline/small_house.h"
#include "tests/testing/file_bytes.h"

namespace stormcellar::pipeline {
namespace {

using std::chrono::hours;
using std::chrono::minutes;

class MendCache : public SmallHouse {
  protected:
    void SetUp() override { STORMCELLAR_NEED_DATA(); }

    void take_in(std::size_t volumes) {
        for (std::size_t i = 0; i < volumes; ++i) {
            const std::string& name = sequence[i];
            const fs::path raw = directory_ / name;
            fs::copy_file(testing::real_file("sequence-kbgm") / name, raw);
            const auto outcome = ingestor_.ingest(raw, false);
            ASSERT_TRUE(outcome) << outcome.error().message;
            ASSERT_EQ(outcome->result(), IngestResult::gridded) << outcome->reason;
        }
    }
    void expect_all_good(std::size_t count) {
        EXPECT_EQ(grids("KBGM").size(), count);
        for (const auto& grid : grids("KBGM")) {
            const auto file = cache::GridFile::open(grid.path);
            ASSERT_TRUE(file) << file.error().message;
            EXPECT_TRUE(file->verify());
        }
    }
    CacheMender mender_{catalog_, store_, ingestor_, {level2::Moment::ref}};
};

TEST_F(MendCache, AGridThatWasCutIsMadeAgainFromItsFile) {
    take_in(1);
    const auto grid = grids("KBGM").at(0);
    const auto good = *read_file(grid.path);
    EXPECT_EQ(mender_.mend(grid, MendDepth::header)->condition, GridCondition::sound);
    fs::resize_file(grid.path, good.size() / 2);
    const auto mended = mender_.mend(grid, MendDepth::header);
    ASSERT_TRUE(mended) << mended.error().message;
    EXPECT_EQ(mended->condition, GridCondition::made_again);
    EXPECT_TRUE(mended->reason.starts_with(grid.path.native())) << mended->reason;
    EXPECT_EQ(mended->from, directory_ / "KBGM20050822_024414.gz");
    EXPECT_EQ(*read_file(grid.path), good) << "the grid should have the same bytes";
    EXPECT_EQ(catalog_.list("KBGM", {})->at(0).state, catalog::FileState::complete);
}

TEST_F(MendCache, EachOfSeveralMomentsIsMadeAgain) {
    STORMCELLAR_NEED_DATA();
    IngestOptions options = small_grid();
    options.moments = {level2::Moment::ref, level2::Moment::vel};
    Ingestor both(catalog_, store_, options);
    CacheMender mender(catalog_, store_, both, options.moments);
    const fs::path raw = directory_ / "KLOT20220317_000842_V06";
    fs::copy_file(testing::real_file("volumes/KLOT20220317_000842_V06"), raw);
    fs::permissions(raw, fs::perms::owner_write, fs::perm_options::add);
    ASSERT_EQ(both.ingest(raw, true)->grids.size(), 2U);
    const auto velocities = [&] {
        return *store_.list("KLOT", level2::Moment::vel, std::nullopt, std::nullopt);
    };
    ASSERT_EQ(velocities().size(), 1U);
    const cache::StoreEntry velocity = velocities().front();
    const auto good = *read_file(velocity.path);
    fs::resize_file(velocity.path, good.size() / 2);
    EXPECT_EQ(mender.mend(velocity, MendDepth::header)->condition, GridCondition::made_again);
    EXPECT_EQ(*read_file(velocity.path), good);
    fs::remove(velocity.path);
    const auto missing = mender.missing(hours{6});
    ASSERT_TRUE(missing);
    ASSERT_EQ(missing->size(), 1U);
    EXPECT_EQ(missing->front().names,
              (std::vector<cache::GridName>{{"KLOT", level2::Moment::vel, velocity.time}}));
    ASSERT_TRUE(mender.make(missing->front()));
    EXPECT_EQ(*read_file(velocity.path), good);
    // If the configuration no longer has the moment, the damaged grid is removed.
    fs::resize_file(velocity.path, good.size() / 2);
    EXPECT_EQ(mender_.mend(velocity, MendDepth::header)->condition, GridCondition::dropped);
}

TEST_F(MendCache, AnAlteredCodeIsFoundWhenAllIsRead) {
    take_in(1);
    const auto grid = grids("KBGM").at(0);
    testing::alter_last_byte_of(grid.path);
    EXPECT_EQ(mender_.mend(grid, MendDepth::header)->condition, GridCondition::sound);
    EXPECT_EQ(mender_.mend(grid, MendDepth::all)->condition, GridCondition::made_again);
    expect_all_good(1);
}

TEST_F(MendCache, ADamagedGridWithoutItsFileIsDropped) {
    take_in(2);
    fs::remove(directory_ / "KBGM20050822_024414.gz");
    std::ofstream(directory_ / "KBGM20050822_025001.gz", std::ios::app) << "changed since";
    for (const auto& grid : grids("KBGM")) {
        fs::resize_file(grid.path, 4096);
        const auto mended = mender_.mend(grid, MendDepth::header);
        ASSERT_TRUE(mended);
        EXPECT_EQ(mended->condition, GridCondition::dropped);
        EXPECT_FALSE(fs::exists(grid.path));
    }
}

// 2026-11-25: any file in the place of a cataloged file was gridded as if it were that file.
TEST_F(MendCache, AnotherFileOfTheSameSizeAndTimeIsNotTheOneThatWasCataloged) {
    take_in(2);
    for (const char* name : {"KBGM20050822_024414.gz", "KBGM20050822_025001.gz"}) {
        const auto time = fs::last_write_time(directory_ / name);
        testing::alter_last_byte_of(directory_ / name);
        fs::last_write_time(directory_ / name, time);
    }
    const auto first = grids("KBGM").at(0), second = grids("KBGM").at(1);
    fs::resize_file(first.path, 4096);
    const auto mended = mender_.mend(first, MendDepth::header);
    ASSERT_TRUE(mended) << mended.error().message;
    EXPECT_EQ(mended->condition, GridCondition::dropped);
    EXPECT_NE(mended->why_not.find("is not the file that was cataloged"), std::string::npos)
        << mended->why_not;
    fs::remove(second.path);
    const auto missing = mender_.missing(hours{6});
    ASSERT_TRUE(missing);
    ASSERT_EQ(missing->size(), 2U);
    EXPECT_EQ(mender_.make(missing->at(0)).error().code, ErrorCode::corrupt);
    EXPECT_TRUE(grids("KBGM").empty());
    EXPECT_EQ(mender_.missing(hours{6})->size(), 1U)
        << "a grid that could not be made should not be tried again";
    for (const auto& row : *catalog_.list("KBGM", {}))
        EXPECT_EQ(row.state, catalog::FileState::complete)
            << "the rows of the cataloged files must not change";
}

TEST_F(MendCache, ADatabaseThatCannotBeReadIsItsOwnStationsTrouble) {
    take_in(1);
    fs::remove(grids("KBGM").at(0).path);
    std::ofstream(directory_ / "catalog/KAAA.sqlite") << std::string(8192, 'x');
    fs::permissions(directory_ / "catalog/KAAA.sqlite", fs::perms::none);
    fs::create_directory(directory_ / "catalog/KZZZ.sqlite");
    const auto missing = mender_.missing(hours{6});
    ASSERT_TRUE(missing) << missing.error().message;
    EXPECT_EQ(missing->size(), 1U);
}

TEST_F(MendCache, AGridThatWasEvictedMeanwhileIsNoDamage) {
    take_in(1);
    const auto grid = grids("KBGM").at(0);
    fs::remove(grid.path);
    EXPECT_EQ(mender_.mend(grid, MendDepth::all)->condition, GridCondition::sound);
    EXPECT_TRUE(grids("KBGM").empty()) << "mend() should not make a missing grid";
}

TEST_F(MendCache, WhatIsOfALaterVersionIsLeftAlone) {
    take_in(1);
    const auto grid = grids("KBGM").at(0);
    auto bytes = *read_file(grid.path);
    bytes[12] = std::byte{9};  // the version
    testing::write_bytes(grid.path, bytes);
    EXPECT_EQ(mender_.mend(grid, MendDepth::all)->condition, GridCondition::left_alone);
    EXPECT_TRUE(fs::exists(grid.path));
}

TEST_F(MendCache, AWipedCacheIsFilledNewestFirst) {
    take_in(3);
    fs::remove_all(directory_ / "cache/KBGM");
    int steps = 0;
    const auto missing = mender_.missing(hours{6}, [&] { ++steps; });
    ASSERT_TRUE(missing);
    ASSERT_EQ(missing->size(), 3U);
    EXPECT_EQ(steps, 1) << "step is called for each station";
    EXPECT_GT(missing->at(0).time, missing->at(1).time);
    for (const MissingGrid& grid : *missing)
        EXPECT_EQ(mender_.make(grid)->result(), IngestResult::gridded);
    expect_all_good(3);
    EXPECT_TRUE(mender_.missing(hours{6})->empty());
}

// The volumes are six minutes apart.
TEST_F(MendCache, OnlyTheNewestOfAWipedCacheAreFilled) {
    take_in(3);
    fs::remove_all(directory_ / "cache/KBGM");
    EXPECT_EQ(mender_.missing(minutes{0})->size(), 1U);
    EXPECT_EQ(mender_.missing(minutes{7})->size(), 2U);
}

TEST_F(MendCache, WhatWasEvictedIsNotFilledInAgainAndAGapIs) {
    take_in(3);
    const auto all = grids("KBGM");
    fs::remove(all[0].path);
    EXPECT_TRUE(mender_.missing(hours{6})->empty())
        << "a grid older than all others counts as evicted";
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

// Tests that damaged partials and frames of a mosaic of one site are made again.
class MendMosaic : public SmallHouse {
  protected:
    MendMosaic() : SmallHouse(with_domain()) {}
    void SetUp() override {
        STORMCELLAR_NEED_DATA();
        for (const std::string& name : sequence) {
            fs::copy_file(testing::real_file("sequence-kbgm") / name, directory_ / name);
            ASSERT_TRUE(ingestor_.ingest(directory_ / name, false));
        }
        ASSERT_EQ(partials().size(), 3U);
        ASSERT_EQ(frames().size(), 2U);
        for (const auto& entry : all())
            good_[entry.path] = codes_of(entry.path);
    }
    std::vector<cache::StoreEntry> partials() { return grids("north.KBGM"); }
    std::vector<cache::StoreEntry> frames() { return grids("north"); }
    std::vector<cache::StoreEntry> all() {
        std::vector<cache::StoreEntry> entries = partials();
        for (const auto& frame : frames())
            entries.push_back(frame);
        return entries;
    }
    static std::vector<std::byte> codes_of(const fs::path& path) {
        const auto file = cache::GridFile::open(path);
        EXPECT_TRUE(file && file->verify()) << path;
        if (!file) return {};
        const auto codes = file->view().codes;
        return {codes.begin(), codes.end()};
    }
    void expect_all_as_before() {
        EXPECT_EQ(all().size(), good_.size());
        for (const auto& [path, codes] : good_)
            EXPECT_EQ(codes_of(path), codes) << path;
    }
    // Mends as after a restart, with nothing kept in memory.
    Result<MendedGrid> mend_afresh(const cache::StoreEntry& entry, MendDepth depth) {
        Ingestor ingestor(catalog_, store_, with_domain());
        return CacheMender(catalog_, store_, ingestor, {level2::Moment::ref}).mend(entry, depth);
    }
    static IngestOptions with_domain() {
        IngestOptions options;
        options.spacing_m = 8000;
        options.nx = options.ny = 60;
        options.domains = {small_domain()};
        return options;
    }

    CacheMender mender_{catalog_, store_, ingestor_, {level2::Moment::ref}};
    std::map<fs::path, std::vector<std::byte>> good_;
};

// Damages every partial and every frame, one after the other, by a wrong byte and by truncation.
TEST_F(MendMosaic, DamagedPartialsComeFromRawFilesAndFramesFromPartials) {
    for (const auto& entry : all()) {
        const bool is_frame = entry.domain == "north";
        const std::string from =
            is_frame
                ? "the partials of KBGM"
                : (directory_ / fmt::format("KBGM{:%Y%m%d_%H%M%S}.gz",
                                            std::chrono::floor<std::chrono::seconds>(entry.time)))
                      .native();
        for (const MendDepth depth : {MendDepth::all, MendDepth::header}) {
            if (depth == MendDepth::all) {
                testing::alter_last_byte_of(entry.path);
            } else {
                fs::resize_file(entry.path, 5000);
            }
            const auto mended = mend_afresh(entry, depth);
            ASSERT_TRUE(mended) << mended.error().message;
            EXPECT_EQ(mended->condition, GridCondition::made_again) << mended->why_not;
            EXPECT_TRUE(mended->reason.starts_with(entry.path.native())) << mended->reason;
            EXPECT_EQ(mended->from, from);
            expect_all_as_before();
        }
    }
}

TEST_F(MendMosaic, AFrameMadeOfWhatIsDamagedTooSaysSoAndIsPutRightWithIt) {
    const auto frame = frames().at(1);  // from the second and the third volume
    const auto partial = partials().at(2);
    testing::alter_last_byte_of(frame.path);
    testing::alter_last_byte_of(partial.path);
    const auto first = mend_afresh(frame, MendDepth::all);
    ASSERT_TRUE(first);
    EXPECT_EQ(first->condition, GridCondition::made_again);
    EXPECT_NE(first->from.find("left out: " + partial.path.native()), std::string::npos)
        << first->from;
    EXPECT_NE(codes_of(frame.path), good_[frame.path]);
    EXPECT_EQ(mender_.mend(partial, MendDepth::all)->condition, GridCondition::made_again);
    expect_all_as_before();
}

TEST_F(MendMosaic, DeletedPartialsAndFramesAreMissing) {
    fs::remove(partials().at(1).path);
    fs::remove(frames().at(1).path);
    auto missing = mender_.missing(hours{6});
    ASSERT_TRUE(missing);
    ASSERT_EQ(missing->size(), 1U);
    EXPECT_EQ(missing->at(0).raw, directory_ / "KBGM20050822_025001.gz");
    ASSERT_EQ(missing->at(0).names.size(), 1U)
        << "the site's own grid exists, so only the partial is missing";
    EXPECT_EQ(missing->at(0).names[0].domain, "north.KBGM");
    ASSERT_TRUE(mender_.make(missing->at(0)));
    expect_all_as_before();  // frames are made with the partial

    fs::remove(frames().at(1).path);
    const auto lost = mender_.missing_frames(hours{6});
    ASSERT_EQ(lost->size(), 1U);
    EXPECT_EQ(*mender_.make(lost->at(0)), "the partials of KBGM");
    expect_all_as_before();
    EXPECT_TRUE(mender_.missing(hours{6})->empty());
    EXPECT_TRUE(mender_.missing_frames(hours{6})->empty());
}

TEST_F(MendMosaic, AWipedCacheHasItsMosaicsAgain) {
    fs::remove_all(directory_ / "cache/north");
    fs::remove_all(directory_ / "cache/north.KBGM");
    fs::remove_all(directory_ / "cache/KBGM");
    const auto missing = mender_.missing(hours{6});
    ASSERT_TRUE(missing);
    EXPECT_EQ(missing->size(), 3U);
    for (const MissingGrid& grid : *missing) {
        EXPECT_EQ(grid.names.size(), 2U);
        const auto made = mender_.make(grid);
        ASSERT_TRUE(made) << made.error().message;
    }
    expect_all_as_before();
}

TEST_F(MendMosaic, WhatCannotBeMadeAgainIsDroppedWithTheReason) {
    const auto dropped = [&](const cache::StoreEntry& entry) {
        fs::resize_file(entry.path, 5000);
        const auto mended = mender_.mend(entry, MendDepth::header);
        EXPECT_TRUE(mended);
        if (!mended) return std::string{};
        EXPECT_EQ(mended->condition, GridCondition::dropped);
        EXPECT_FALSE(fs::exists(entry.path));
        return mended->why_not;
    };
    const auto frame = frames().at(1);
    for (const auto& partial : partials()) {
        fs::remove(directory_ /
                   fmt::format("KBGM{:%Y%m%d_%H%M%S}.gz",
                               std::chrono::floor<std::chrono::seconds>(partial.time)));
        EXPECT_EQ(dropped(partial), "its raw file is gone, has changed or still grows");
    }
    EXPECT_EQ(dropped(frame), "no site has a volume within 15 minutes of 2005-08-22T02:55:00Z");
    Ingestor without(catalog_, store_, {});
    CacheMender other(catalog_, store_, without, {level2::Moment::ref});
    const auto stray = frames().at(0);
    fs::resize_file(stray.path, 5000);
    EXPECT_EQ(other.mend(stray, MendDepth::header)->why_not,
              "the configuration no longer has REF of north");
    EXPECT_TRUE(all().empty());
}

}  // namespace
}  // namespace stormcellar::pipeline
