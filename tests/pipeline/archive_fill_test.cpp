// Tests that the grids of an archive equal the daemon's, are made once, and leave out files that
// cannot be read.
#include "pipeline/care/archive_fill.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/care/archive_frames.h"
#include "pipeline/mosaic/mosaic_maker.h"
#include "stormcellar/cache/grid_file.h"
#include "tests/pipeline/small_domain.h"
#include "tests/pipeline/small_house.h"
#include "tests/testing/metered_file_system.h"

namespace stormcellar::pipeline {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

UtcTime at(const std::string& text) {
    return *parse_utc(text, UtcTime{});
}

class ArchiveFillTest : public ::testing::Test {
  protected:
    void SetUp() override {
        STORMCELLAR_NEED_DATA();
        catalog_real_volumes(directory_.path(), sequence);
        if (HasFatalFailure()) return;
        catalog_.emplace(*catalog::CatalogReader::open(directory_ / "catalog"));
    }
    [[nodiscard]] fs::path raw(const std::string& name) const { return directory_ / "drop" / name; }
    [[nodiscard]] cache::StoreWriter store(const std::string& name) const {
        return std::move(*cache::StoreWriter::open(real_file_system(), directory_ / name, true));
    }
    [[nodiscard]] std::vector<ArchiveVolume> volumes() const {
        return *archive_volumes(*catalog_, {"KBGM"},
                                {at("2005-08-22T02:00Z"), at("2005-08-22T04:00Z"), false});
    }
    [[nodiscard]] ArchiveOptions options() const {
        ArchiveOptions options;
        options.nx = options.ny = 120;
        options.spacing_m = 4000;
        options.levels_m = {1000, 2000, 4000};
        options.threads = 2;
        return options;
    }
    [[nodiscard]] FillReport fill(cache::StoreWriter& store, const ArchiveOptions& options) const {
        FillReport report;
        ArchiveFill filling(*catalog_, store, directory_ / "scratch", options);
        const auto missing = filling.missing(volumes());
        EXPECT_TRUE(missing);
        const Status filled = filling.fill(*missing, {}, stop_, report);
        EXPECT_TRUE(filled) << filled.error().message;
        const Status framed = filling.make_frames(instants_, {}, stop_, report);
        EXPECT_TRUE(framed) << framed.error().message;
        return report;
    }
    static std::vector<std::byte> bytes_of(const fs::path& path) { return *read_file(path); }

    testing::TemporaryDirectory directory_;
    std::optional<catalog::CatalogReader> catalog_;
    std::atomic<bool> stop_{false};
    std::vector<UtcTime> instants_ =
        instants_between(at("2005-08-22T02:00Z"), at("2005-08-22T04:00Z"), std::chrono::minutes{5});
};

TEST_F(ArchiveFillTest, OwnGridsAreToTheByteThoseOfTheDaemon) {
    cache::StoreWriter filled = store("filled"), kept = store("kept");
    const FillReport report = fill(filled, options());
    EXPECT_EQ(report.grids_made, 3U);
    EXPECT_THAT(report.left_out, IsEmpty());
    EXPECT_THAT(report.frames, IsEmpty());

    auto catalog = catalog::CatalogWriter::open(directory_ / "daemon");
    IngestOptions ingest;
    ingest.nx = ingest.ny = 120;
    ingest.spacing_m = 4000;
    ingest.levels_m = options().levels_m;
    Ingestor ingestor(*catalog, kept, ingest);
    for (const std::string& name : sequence) {
        const auto outcome = ingestor.ingest(raw(name), false);
        ASSERT_TRUE(outcome);
        const fs::path relative = fs::relative(outcome->grids.at(0), directory_ / "kept");
        EXPECT_EQ(bytes_of(outcome->grids.at(0)), bytes_of(directory_ / "filled" / relative));
    }
}

// Tests in wanted_echo_test.cpp and living_dealiasing_test.cpp compare the daemon's grids with
// those of `stormcellar grid FILE`.
TEST_F(ArchiveFillTest, GridsOfWeatherAndOfDealiasedVelocitiesAreThoseOfTheDaemon) {
    cache::StoreWriter filled = store("filled"), kept = store("kept");
    retrieve::DerivedOptions derived;
    derived.quality = 0.5;
    derived.dealiasing = retrieve::Dealiasing::region;
    auto catalog = catalog::CatalogWriter::open(directory_ / "daemon");
    IngestOptions ingest;
    ingest.moments = {level2::Moment::ref, level2::Moment::veld, level2::Moment::azsh};
    ingest.derived = derived;
    ingest.nx = ingest.ny = 120;
    ingest.spacing_m = 4000;
    ingest.levels_m = options().levels_m;
    Ingestor ingestor(*catalog, kept, ingest);
    for (const std::string& name : sequence)
        ASSERT_TRUE(ingestor.ingest(raw(name), false));
    for (const level2::Moment moment : ingest.moments) {
        SCOPED_TRACE(level2::moment_name(moment));
        ArchiveOptions all = options(), weather = options();
        all.moment = weather.moment = moment;
        weather.derived = derived;
        EXPECT_EQ(fill(filled, all).grids_made, 3U);
        EXPECT_EQ(fill(filled, weather).grids_made, 3U)
            << "grids of all echo do not count as grids of weather";
        EXPECT_EQ(fill(filled, weather).grids_made, 0U);
        const auto daemons = *kept.list("KBGM", moment, {}, {});
        ASSERT_THAT(daemons, SizeIs(3));
        for (const cache::StoreEntry& entry : daemons)
            EXPECT_EQ(bytes_of(*filled.path_of("KBGM", moment, entry.time)), bytes_of(entry.path));
        EXPECT_EQ(fill(filled, all).grids_made, 3U);
        EXPECT_NE(bytes_of(*filled.path_of("KBGM", moment, daemons[0].time)),
                  bytes_of(daemons[0].path));
    }
    // The notes of AZSH name the rung of dealiasing.
    ArchiveOptions profile = options();
    profile.moment = level2::Moment::azsh;
    profile.derived.dealiasing = retrieve::Dealiasing::profile;
    EXPECT_EQ(fill(filled, profile).grids_made, 3U);
    EXPECT_EQ(fill(filled, profile).grids_made, 0U);
}

TEST_F(ArchiveFillTest, FramesHaveTheCellsAndPartsOfTheDaemons) {
    cache::StoreWriter filled = store("filled"), kept = store("kept");
    ArchiveOptions mosaic = options();
    mosaic.domain = small_domain();
    const FillReport report = fill(filled, mosaic);
    EXPECT_EQ(report.grids_made, 3U);
    ASSERT_THAT(report.frames, SizeIs(2));  // between the middles of the first volume and the last
    EXPECT_EQ(report.frames_made, 2U);
    EXPECT_THAT(*filled.list("KBGM", level2::Moment::ref, {}, {}), IsEmpty());

    auto catalog = catalog::CatalogWriter::open(directory_ / "daemon");
    IngestOptions ingest;
    ingest.domains = {small_domain()};
    Ingestor ingestor(*catalog, kept, ingest);
    for (const std::string& name : sequence)
        ASSERT_TRUE(ingestor.ingest(raw(name), false));
    const auto daemons = kept.list("north", level2::Moment::ref, {}, {});
    ASSERT_THAT(*daemons, SizeIs(2));
    for (const cache::StoreEntry& entry : *daemons) {
        const auto theirs = cache::GridFile::open(entry.path);
        const auto ours =
            cache::GridFile::open(*filled.path_of("north", level2::Moment::ref, entry.time));
        ASSERT_TRUE(theirs && ours);
        EXPECT_TRUE(std::equal(theirs->view().codes.begin(), theirs->view().codes.end(),
                               ours->view().codes.begin(), ours->view().codes.end()));
        EXPECT_EQ(theirs->description().provenance.parts, ours->description().provenance.parts);
        EXPECT_EQ(theirs->checksum(), ours->checksum());
    }
}

TEST_F(ArchiveFillTest, ASecondCallMakesOnlyWhatIsNotThere) {
    cache::StoreWriter filled = store("filled");
    ArchiveOptions mosaic = options();
    mosaic.domain = small_domain();
    static_cast<void>(fill(filled, mosaic));
    const FillReport again = fill(filled, mosaic);
    EXPECT_EQ(again.grids_made, 0U);
    EXPECT_EQ(again.frames_made, 0U);
    EXPECT_EQ(again.frames_found, 2U);

    // A removed partial is made again, and the frames stay.
    const auto partials = filled.list("north.KBGM", level2::Moment::ref, {}, {});
    ASSERT_TRUE(filled.remove(partials->at(1)));
    const FillReport third = fill(filled, mosaic);
    EXPECT_EQ(third.grids_made, 1U);
    EXPECT_EQ(third.frames_found, 2U);
}

TEST_F(ArchiveFillTest, AFrameOfOtherPartialsOrRulesIsMadeAgain) {
    cache::StoreWriter filled = store("filled");
    ArchiveOptions mosaic = options();
    mosaic.domain = small_domain();
    static_cast<void>(fill(filled, mosaic));
    mosaic.domain->time = grid::TimeMethod::nearest;
    const FillReport other = fill(filled, mosaic);
    EXPECT_EQ(other.grids_made, 0U);
    EXPECT_EQ(other.frames_made, 2U);
    const auto frame = filled.list("north", level2::Moment::ref, {}, {})->at(0);
    EXPECT_THAT(cache::GridFile::open(frame.path)->description().provenance.effects,
                HasSubstr("time: nearest"));
}

TEST_F(ArchiveFillTest, FramesAreTheSameByAnyNumberOfWorkersAndHoweverOftenTheyAreMade) {
    ArchiveOptions mosaic = options();
    mosaic.domain = small_domain();
    mosaic.domain->interval = std::chrono::minutes{1};
    instants_ =
        instants_between(at("2005-08-22T02:45Z"), at("2005-08-22T03:00Z"), mosaic.domain->interval);
    mosaic.threads = 1;
    cache::StoreWriter one = store("one"), three = store("three");
    const FillReport alone = fill(one, mosaic);
    ASSERT_GT(alone.frames_made, 8U);  // a worker makes four frames in one turn
    mosaic.threads = 3;
    ASSERT_EQ(fill(three, mosaic).frames, alone.frames);
    // First, the cache has a frame that was made by other rules.
    Domain nearest = *mosaic.domain;
    nearest.time = grid::TimeMethod::nearest;
    FillReport ignored;
    ASSERT_TRUE(make_frames(three, nearest, mosaic.moment, instants_, 2, {}, stop_, ignored));
    ASSERT_EQ(ignored.frames_made, alone.frames_made);
    ASSERT_EQ(fill(three, mosaic).frames_made, alone.frames_made);
    for (const UtcTime instant : alone.frames) {
        EXPECT_EQ(bytes_of(*one.path_of("north", mosaic.moment, instant)),
                  bytes_of(*three.path_of("north", mosaic.moment, instant)));
    }
}

TEST_F(ArchiveFillTest, WhatCannotBeReadIsNamedAndLeftOut) {
    std::ofstream(raw(sequence[0]), std::ios::trunc) << "no radar data at all, but some bytes";
    fs::remove(raw(sequence[2]));
    cache::StoreWriter filled = store("filled");
    const FillReport report = fill(filled, options());
    EXPECT_EQ(report.grids_made, 1U);
    ASSERT_THAT(report.left_out, SizeIs(2));
    EXPECT_EQ(report.left_out[0].path.filename(), sequence[0]);
    EXPECT_NE(report.left_out[0].reason, "");
    EXPECT_EQ(report.left_out[1].path.filename(), sequence[2]);
    EXPECT_EQ(report.left_out[1].reason, "is gone");
}

// 2026-11-24: any file in the place of a cataloged file was gridded.
TEST_F(ArchiveFillTest, WhatIsNotTheFileThatWasCatalogedIsNamedAndLeftOut) {
    fs::rename(raw(sequence[0]), directory_ / "elsewhere");
    fs::create_symlink(directory_ / "elsewhere", raw(sequence[0]));
    // The file is replaced by another valid volume of the same size.
    const auto size = fs::file_size(raw(sequence[1]));
    fs::copy_file(testing::real_file("sequence-kbgm/KBGM20050822_030830.gz"), raw(sequence[1]),
                  fs::copy_options::overwrite_existing);
    fs::permissions(raw(sequence[1]), fs::perms::owner_write, fs::perm_options::add);
    fs::resize_file(raw(sequence[1]), size);
    cache::StoreWriter filled = store("filled");
    const FillReport report = fill(filled, options());
    EXPECT_EQ(report.grids_made, 1U);
    EXPECT_THAT(*filled.list("KBGM", level2::Moment::ref, {}, {}), SizeIs(1));
    ASSERT_THAT(report.left_out, SizeIs(2));
    EXPECT_EQ(report.left_out[0].path.filename(), sequence[0]);
    EXPECT_EQ(report.left_out[0].reason, "is a symbolic link");
    EXPECT_EQ(report.left_out[1].path.filename(), sequence[1]);
    EXPECT_THAT(report.left_out[1].reason, HasSubstr("is not the file that was cataloged"));
}

TEST_F(ArchiveFillTest, FilesBehindADirectoryThatBecameALinkAreGone) {
    fs::create_directory(directory_ / "drop/day");
    fs::rename(raw(sequence[0]), directory_ / "drop/day" / sequence[0]);
    RebuildOptions rebuild;
    rebuild.catalog = directory_ / "catalog";
    rebuild.drop = directory_ / "drop";
    ASSERT_TRUE(rebuild_catalog(rebuild));
    fs::rename(directory_ / "drop/day", directory_ / "elsewhere");
    fs::create_directory_symlink(directory_ / "elsewhere", directory_ / "drop/day");
    cache::StoreWriter filled = store("filled");
    const FillReport report = fill(filled, options());
    EXPECT_EQ(report.grids_made, 2U);
    ASSERT_THAT(report.left_out, SizeIs(1));
    EXPECT_EQ(report.left_out[0].reason, "is gone");
}

TEST_F(ArchiveFillTest, AGridOfAFileThatIsGoneSinceStands) {
    cache::StoreWriter filled = store("filled");
    static_cast<void>(fill(filled, options()));
    const auto all = volumes();
    fs::remove(raw(sequence[2]));
    ArchiveFill filling(*catalog_, filled, directory_ / "scratch", options());
    EXPECT_THAT(*filling.missing(all), IsEmpty());
    ArchiveOptions finer = options();
    finer.nx = 100;
    EXPECT_THAT(*ArchiveFill(*catalog_, filled, directory_ / "scratch", finer).missing(all),
                SizeIs(3));
}

TEST_F(ArchiveFillTest, AFullDiskIsAnErrorAndWhatWasMadeStays) {
    testing::MeteredFileSystem disk(directory_ / "filled");
    auto filled = cache::StoreWriter::open(disk, directory_ / "filled", true);
    ASSERT_TRUE(filled);
    disk.set_capacity(300'000);  // one grid of this size, not three
    FillReport report;
    ArchiveOptions alone = options();
    alone.threads = 1;
    ArchiveFill filling(*catalog_, *filled, directory_ / "scratch", alone);
    const Status full = filling.fill(volumes(), {}, stop_, report);
    ASSERT_FALSE(full);
    EXPECT_EQ(full.error().code, ErrorCode::no_space);
    EXPECT_EQ(report.grids_made, 1U);
    disk.set_capacity(100'000'000);
    EXPECT_EQ(fill(*filled, alone).grids_made, 2U);
}

TEST_F(ArchiveFillTest, NoVolumeBeginsOnceItIsToStop) {
    stop_ = true;
    cache::StoreWriter filled = store("filled");
    const FillReport report = fill(filled, options());
    EXPECT_EQ(report.grids_made, 0U);
    EXPECT_THAT(report.left_out, IsEmpty());
}

TEST_F(ArchiveFillTest, TheGuessOfBytesIsOnTheSafeSide) {
    cache::StoreWriter filled = store("filled");
    static_cast<void>(fill(filled, options()));
    std::uint64_t bytes = 0;
    const auto entries = filled.list("KBGM", level2::Moment::ref, {}, {});
    for (const cache::StoreEntry& entry : *entries)
        bytes += entry.bytes_on_disk;
    const ArchiveFill filling(*catalog_, filled, directory_ / "scratch", options());
    EXPECT_GE(filling.bytes_of(3, 0), bytes);
    EXPECT_LE(filling.bytes_of(3, 0), 4 * bytes);
    EXPECT_EQ(filling.bytes_of(0, 0), 0U);
}

// Catalogs of made-up files.
class ArchiveVolumesTest : public ::testing::Test {
  protected:
    void add(const std::string& name, const std::string& start, const std::string& end,
             bool complete = true) {
        catalog::FileFacts facts;
        facts.path = "/archive/" + name;
        facts.station = "KTLX";
        facts.size_bytes = 100;
        facts.content_hash = std::hash<std::string>{}(name);
        facts.state = catalog::FileState::complete;
        catalog::VolumeFacts volume;
        volume.start_time = at("2013-05-20T" + start + "Z");
        volume.end_time = at("2013-05-20T" + end + "Z");
        volume.complete = complete;
        facts.volumes = {volume};
        ASSERT_TRUE(catalog_.register_file(facts));
    }
    [[nodiscard]] std::vector<std::string> taken(const std::string& from, const std::string& to,
                                                 bool with_neighbours) {
        const auto volumes = archive_volumes(
            catalog_, {"KTLX", "KFDR"},
            {at("2013-05-20T" + from + "Z"), at("2013-05-20T" + to + "Z"), with_neighbours});
        EXPECT_TRUE(volumes);
        std::vector<std::string> names;
        for (const ArchiveVolume& volume : *volumes)
            names.push_back(volume.path.filename());
        return names;
    }

    testing::TemporaryDirectory directory_;
    catalog::CatalogWriter catalog_ = std::move(*catalog::CatalogWriter::open(directory_ / "c"));
};

TEST_F(ArchiveVolumesTest, ThoseThatOverlapTheRangeAndTheirNeighbours) {
    add("a", "20:00", "20:04");
    add("b", "20:05", "20:09");
    add("c", "20:10", "20:14");
    add("d", "20:15", "20:19");
    add("far", "21:30", "21:34");
    using ::testing::ElementsAre;
    EXPECT_THAT(taken("20:07", "20:12", false), ElementsAre("b", "c"));
    EXPECT_THAT(taken("20:07", "20:12", true), ElementsAre("a", "b", "c", "d"));
    EXPECT_THAT(taken("20:09:30", "20:09:40", false), ElementsAre());
    EXPECT_THAT(taken("20:09:30", "20:09:40", true), ElementsAre("b", "c"));
    EXPECT_THAT(taken("20:18", "20:40", true), ElementsAre("c", "d"));  // 21:30 is too far
}

TEST_F(ArchiveVolumesTest, AStationWhoseDatabaseCannotBeReadDoesNotKeepItFromTheOthers) {
    add("a", "20:00", "20:04");
    fs::create_directory(directory_ / "c/KFDR.sqlite");
    EXPECT_THAT(taken("20:00", "20:10", false), ::testing::ElementsAre("a"));
    EXPECT_THAT(catalog_.troubles(), SizeIs(1));
    const auto alone = archive_volumes(catalog_, {"KFDR"},
                                       {at("2013-05-20T20:00Z"), at("2013-05-20T21:00Z"), false});
    ASSERT_FALSE(alone);
    EXPECT_EQ(alone.error().code, ErrorCode::not_a_file);
}

TEST_F(ArchiveVolumesTest, AVolumeSentTwiceIsTakenOnceTheWholeOne) {
    add("whole", "20:00", "20:04");
    add("part", "20:00", "20:02", false);
    EXPECT_THAT(taken("20:00", "20:10", false), ::testing::ElementsAre("whole"));
}

}  // namespace
}  // namespace stormcellar::pipeline
