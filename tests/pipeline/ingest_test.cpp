// Tests the catalog and the cache after real files went through the whole pipeline.
#include "pipeline/ingest/ingest.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "stormcellar/cache/grid_file.h"
#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/grid/column_geometry.h"
#include "stormcellar/grid/gridder.h"
#include "stormcellar/level2/decode.h"
#include "stormcellar/level2/encode.h"
#include "stormcellar/retrieve/derived_moments.h"
#include "tests/level2/wire.h"
#include "tests/pipeline/small_house.h"
#include "tests/testing/file_bytes.h"

namespace stormcellar::pipeline {
namespace {

using catalog::FileState;
using level2::Moment;

class IngestTest : public SmallHouse {
  protected:
    fs::path write(const std::string& name, const std::string& text) {
        std::ofstream(directory_ / name, std::ios::binary) << text;
        return directory_ / name;
    }
    catalog::CatalogEntry only_entry(const std::string& station) {
        const auto entries = catalog_.list(station, {std::nullopt, std::nullopt, true});
        EXPECT_TRUE(entries);
        EXPECT_EQ(entries->size(), 1U);
        return entries->at(0);
    }
    fs::path put(const std::string& name, std::span<const std::byte> bytes) {
        return write(name, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    }
    cache::GridDescription only_grid(const std::string& domain) {
        const auto entries = grids(domain);
        EXPECT_EQ(entries.size(), 1U);
        return cache::GridFile::open(entries.at(0).path)->description();
    }
};

TEST_F(IngestTest, WholeVolumeIsGriddedOnceAndThenUnchanged) {
    STORMCELLAR_NEED_DATA();
    const fs::path path = testing::real_file("sequence-kbgm/KBGM20050822_024414.gz");
    const auto outcome = ingestor_.ingest(path, false);
    ASSERT_TRUE(outcome) << outcome.error().message;
    EXPECT_EQ(outcome->result(), IngestResult::gridded);
    EXPECT_EQ(outcome->station, "KBGM");
    EXPECT_EQ(only_entry("KBGM").state, FileState::complete);
    EXPECT_EQ(outcome->newest_radial, only_entry("KBGM").volume.end_time);
    EXPECT_GT(*outcome->newest_radial, *outcome->volume_time + std::chrono::minutes{4});
    ASSERT_EQ(grids("KBGM").size(), 1U);
    const auto file = cache::GridFile::open(grids("KBGM")[0].path);
    ASSERT_TRUE(file);
    EXPECT_TRUE(file->verify());
    EXPECT_EQ(file->description().provenance.source_files,
              std::vector<std::string>{"KBGM20050822_024414"});
    EXPECT_FALSE(file->description().provenance.partial);
    EXPECT_EQ(ingestor_.ingest(path, false)->result(), IngestResult::unchanged);
}

TEST_F(IngestTest, AFileIsNotedUnreadAndThenTakenInAsIfItHadNotBeen) {
    STORMCELLAR_NEED_DATA();
    const fs::path path = directory_ / "KBGM20050822_024414.gz";
    EXPECT_EQ(ingestor_.note(path).value(), Noted::gone);
    EXPECT_TRUE(catalog_.station_names()->empty());
    fs::copy_file(testing::real_file("sequence-kbgm/KBGM20050822_024414.gz"), path);
    EXPECT_EQ(ingestor_.note(path).value(), Noted::stands);
    EXPECT_EQ(only_entry("KBGM").state, FileState::seen);
    EXPECT_EQ(only_entry("KBGM").size_bytes, fs::file_size(path));
    EXPECT_FALSE(only_entry("KBGM").volume.start_time);
    EXPECT_TRUE(*catalog_.is_known(path));
    EXPECT_FALSE(*catalog_.is_known(directory_ / "other"));
    ASSERT_EQ(ingestor_.ingest(path, false)->result(), IngestResult::gridded);
    EXPECT_EQ(only_entry("KBGM").state, FileState::complete);
    EXPECT_EQ(only_entry("KBGM").generation, 0);
    ASSERT_TRUE(ingestor_.note(path));
    EXPECT_EQ(only_entry("KBGM").state, FileState::complete)
        << "a note must not change an existing row";
    fs::create_symlink(path, directory_ / "KBGM-link");
    ASSERT_TRUE(ingestor_.note(directory_ / "KBGM-link"));
    EXPECT_EQ(only_entry("KBGM").path, path);
    fs::remove(path);
    EXPECT_EQ(ingestor_.note(path).value(), Noted::gone);
    EXPECT_EQ(only_entry("KBGM").state, FileState::gone);
}

// In the first file, message 2 reports two troubles; in the second file, it reports no trouble.
TEST_F(IngestTest, WhatTheRadarReportsOfItselfStandsInTheGrid) {
    STORMCELLAR_NEED_DATA();
    const auto troubles_of = [&](const std::string& name, const std::string& station) {
        const auto outcome = ingestor_.ingest(testing::real_file(name), false);
        EXPECT_TRUE(outcome) << outcome.error().message;
        const auto file = cache::GridFile::open(grids(station).at(0).path);
        return file->description().provenance.radar_troubles;
    };
    EXPECT_EQ(troubles_of("volumes/KOKX20080109_141449.gz", "KOKX"),
              std::vector<std::string>{"KOKX: maintenance mandatory, receiver alarm"});
    EXPECT_EQ(troubles_of("mosaic-northeast/KBGM20100911_012056_V03.gz", "KBGM"),
              std::vector<std::string>{});
}

// The grid of VELD has the cells that the gridder makes of the dealiased volume. The other moments
// have the same grids as without VELD.
TEST_F(IngestTest, TheDealiasedVelocityIsAGridOfItsOwn) {
    STORMCELLAR_NEED_DATA();
    const fs::path path = testing::real_file("volumes/KTLX19990503_235621.gz");
    IngestOptions options = small_grid();
    options.moments = {Moment::ref, Moment::vel, Moment::veld};
    Ingestor ingestor(catalog_, store_, options);
    const auto outcome = ingestor.ingest(path, false);
    ASSERT_TRUE(outcome) << outcome.error().message;
    EXPECT_EQ(outcome->result(), IngestResult::gridded);
    EXPECT_EQ(outcome->grids.size(), 3U);
    const auto stored = [&](Moment moment) {
        const auto entries = *store_.list("KTLX", moment, std::nullopt, std::nullopt);
        EXPECT_EQ(entries.size(), 1U);
        auto file = cache::GridFile::open(entries.at(0).path);
        EXPECT_TRUE(file && file->verify());
        EXPECT_EQ(file->description().moment, moment);
        return grid::to_dense(file->view());
    };
    const level2::Volume dealiased =
        retrieve::derived_velocities(level2::decode_file(path)->volume, std::array{Moment::veld})
            .value()
            .volume;
    const auto antenna = level2::antenna_position(dealiased).value();
    const grid::SitePosition site{"KTLX", antenna.latitude_deg, antenna.longitude_deg,
                                  antenna.altitude_m};
    const auto file = cache::GridFile::open(
        store_.list("KTLX", Moment::veld, std::nullopt, std::nullopt)->at(0).path);
    const auto geometry = grid::make_column_geometry(site, file->description().spec);
    const auto made = grid::make_grid(dealiased, site, **geometry, {Moment::veld, 0, 1, {}});
    ASSERT_TRUE(made);
    const auto bricks = grid::BrickGrid::from(*made, grid::default_quantization(Moment::veld));
    const grid::Grid expected = grid::to_dense(bricks.view());
    const grid::Grid velocities = stored(Moment::veld);
    EXPECT_EQ(velocities.status, expected.status);
    EXPECT_EQ(velocities.values, expected.values);
    EXPECT_GT(std::ranges::count(velocities.status, grid::CellStatus::ambiguous), 10);
    EXPECT_EQ(std::ranges::count(stored(Moment::vel).status, grid::CellStatus::ambiguous), 0);
    EXPECT_GT(std::ranges::count(stored(Moment::ref).status, grid::CellStatus::value), 1000);
    for (const float value : velocities.values)
        ASSERT_LE(std::abs(value), 120) << "no wind of a tornado is faster";
}

TEST_F(IngestTest, AVolumeWithoutVelocitiesHasNoGridOfVeldAndIsNotRejected) {
    STORMCELLAR_NEED_DATA();
    level2::Volume volume =
        level2::decode_file(testing::real_file("sequence-kbgm/KBGM20050822_024414.gz"))->volume;
    for (level2::Sweep& sweep : volume.sweeps)
        std::erase_if(sweep.moments,
                      [](const level2::SweepMoment& kind) { return kind.moment != Moment::ref; });
    const auto encoded = level2::encode(volume);
    ASSERT_TRUE(encoded) << encoded.error().message;
    const fs::path path = put("KBGM20050822_024414", encoded->joined());
    for (const std::vector<Moment>& moments :
         {std::vector{Moment::ref, Moment::veld}, std::vector{Moment::veld}}) {
        const testing::TemporaryDirectory directory;
        auto catalog = catalog::CatalogWriter::open(directory / "catalog");
        IngestOptions options = small_grid();
        options.moments = moments;
        Ingestor ingestor(*catalog, store_, options);
        const auto outcome = ingestor.ingest(path, false);
        ASSERT_TRUE(outcome) << outcome.error().message;
        EXPECT_NE(outcome->result(), IngestResult::rejected);
        EXPECT_EQ(outcome->grids.size(), moments.size() - 1);
        EXPECT_TRUE(store_.list("KBGM", Moment::veld, std::nullopt, std::nullopt)->empty());
        EXPECT_EQ(catalog->list("KBGM", {})->at(0).state, FileState::complete);
    }
}

TEST_F(IngestTest, AVolumeThatTheCacheWouldNotKeepIsRegisteredAndNotGridded) {
    STORMCELLAR_NEED_DATA();
    cache::Budgets budgets;
    budgets.total.age = std::chrono::minutes{10};
    auto store = *cache::RollingStore::open(real_file_system(), directory_ / "rolling", budgets);
    Ingestor ingestor(catalog_, store, small_grid());
    EXPECT_EQ(ingestor.ingest(testing::real_file("sequence-kbgm/KBGM20050822_030830.gz"), false)
                  ->grids.size(),
              1U);
    const auto old =
        ingestor.ingest(testing::real_file("sequence-kbgm/KBGM20050822_024414.gz"), false);
    ASSERT_TRUE(old) << old.error().message;
    EXPECT_EQ(old->result(), IngestResult::gridded);
    EXPECT_EQ(old->not_kept, 1);
    EXPECT_TRUE(old->grids.empty());
    EXPECT_EQ(old->grid_s, 0);
    EXPECT_EQ(old->reason, "no grid was kept: it would be older than all that the cache keeps");
    EXPECT_EQ(ingestor.ingest(testing::real_file("sequence-kbgm/KBGM20050822_024414.gz"), false)
                  ->result(),
              IngestResult::unchanged);
}

// An independent decoder found four volumes in this file (golden file).
TEST_F(IngestTest, FileOfSeveralVolumesGivesAGridForEach) {
    STORMCELLAR_NEED_DATA();
    const auto outcome =
        ingestor_.ingest(testing::real_file("volumes/KBBX20060113_170337.gz"), true);
    ASSERT_TRUE(outcome) << outcome.error().message;
    EXPECT_EQ(outcome->grids.size(), 4U);
    EXPECT_EQ(grids("KBBX").size(), 4U);
    EXPECT_EQ(catalog_.stations()->at(0).volume_count, 4);
}

TEST_F(IngestTest, VolumeThatHasNotEndedWaitsUntilItIsFinished) {
    STORMCELLAR_NEED_DATA();
    std::string bytes;
    for (const std::string chunk : {"001-S", "002-I", "003-I"})
        bytes += testing::file_text(testing::real_file("chunks/KLOT_34/20201019-054806-" + chunk));
    const fs::path path = write("KLOT20201019_054806_V06", bytes);
    EXPECT_EQ(ingestor_.ingest(path, false)->result(), IngestResult::incomplete);
    EXPECT_EQ(only_entry("KLOT").state, FileState::seen);
    EXPECT_TRUE(grids("KLOT").empty());
    const auto outcome = ingestor_.ingest(path, true);
    EXPECT_EQ(outcome->result(), IngestResult::gridded);
    EXPECT_EQ(only_entry("KLOT").state, FileState::partial);
    EXPECT_NE(only_entry("KLOT").reason, "");
    EXPECT_TRUE(cache::GridFile::open(grids("KLOT").at(0).path)->description().provenance.partial);
}

TEST_F(IngestTest, VolumeWithoutRadialsIsPartialAndHasNoGrid) {
    STORMCELLAR_NEED_DATA();
    const auto outcome =
        ingestor_.ingest(testing::real_file("volumes/KFDR20160420_214957_V06.gz"), true);
    ASSERT_TRUE(outcome) << outcome.error().message;
    EXPECT_EQ(outcome->result(), IngestResult::no_moment);
    EXPECT_EQ(only_entry("KFDR").state, FileState::partial);
    EXPECT_TRUE(grids("KFDR").empty());
}

TEST_F(IngestTest, GarbageIsRejectedWithAReasonAndIsNotTriedAgain) {
    const fs::path path = write("KTLX_nonsense", std::string(5000, 'x'));
    const auto outcome = ingestor_.ingest(path, false);
    ASSERT_TRUE(outcome);
    EXPECT_EQ(outcome->result(), IngestResult::rejected);
    EXPECT_EQ(std::get<ended::Rejected>(outcome->ending).with, ErrorCode::not_level2);
    EXPECT_FALSE(outcome->newest_radial);
    EXPECT_EQ(only_entry("KTLX").state, FileState::rejected);
    EXPECT_NE(only_entry("KTLX").reason, "");
    EXPECT_EQ(ingestor_.ingest(path, true)->result(), IngestResult::unchanged);
}

TEST_F(IngestTest, EmptyFileWaitsAndIsRejectedWhenItStaysEmpty) {
    const fs::path path = write("empty", "");
    EXPECT_EQ(ingestor_.ingest(path, false)->result(), IngestResult::incomplete);
    EXPECT_EQ(ingestor_.ingest(path, true)->result(), IngestResult::rejected);
    EXPECT_EQ(only_entry("").state, FileState::rejected);
}

TEST_F(IngestTest, OddThingsAreRejectedAndNeverFollowed) {
    ASSERT_EQ(::mkfifo((directory_ / "fifo").c_str(), 0600), 0);
    EXPECT_EQ(ingestor_.ingest(directory_ / "fifo", true)->result(), IngestResult::rejected);
    fs::create_symlink("/etc/passwd", directory_ / "link");
    const auto outcome = ingestor_.ingest(directory_ / "link", true);
    EXPECT_EQ(outcome->result(), IngestResult::rejected);
    EXPECT_EQ(outcome->reason, "is a symbolic link");
    EXPECT_EQ(std::get<ended::Rejected>(outcome->ending).with, ErrorCode::not_a_file);
}

// The grid of a truncated copy must not replace the grid of the complete volume.
TEST_F(IngestTest, AWholeGridIsNotReplacedByAPartOfIt) {
    const auto whole = level2::wire::ldm_volume(3, 360);
    const auto cut = std::span(whole).first(whole.size() * 2 / 3);
    ASSERT_EQ(ingestor_.ingest(put("KTLX_whole", whole), false)->result(), IngestResult::gridded);
    const auto of_cut = ingestor_.ingest(put("KTLX_cut", cut), true);
    ASSERT_TRUE(of_cut);
    EXPECT_TRUE(of_cut->partial);
    EXPECT_EQ(of_cut->reason, "not replaced: the cache has a grid of the whole volume");
    EXPECT_FALSE(only_grid("KTLX").provenance.partial);
}

TEST_F(IngestTest, APartIsReplacedByTheWholeVolume) {
    const auto whole = level2::wire::ldm_volume(3, 360);
    const auto cut = std::span(whole).first(whole.size() * 2 / 3);
    ASSERT_EQ(ingestor_.ingest(put("KTLX_cut", cut), true)->result(), IngestResult::gridded);
    EXPECT_TRUE(only_grid("KTLX").provenance.partial);
    const fs::path path = put("KTLX_whole", whole);
    fs::last_write_time(path, fs::file_time_type::clock::now() - std::chrono::hours(1));
    const auto of_whole = ingestor_.ingest(path, false);
    EXPECT_FALSE(of_whole->partial);
    EXPECT_FALSE(only_grid("KTLX").provenance.partial);
}

// If two complete files hold one volume, the same file always gives the grid, in any order and with
// any modification times. If that file is deleted, the other gives the grid.
TEST_F(IngestTest, OfTwoWholeFilesOfAVolumeTheSameOneCountsInAnyOrder) {
    const auto write_file = [&](const std::string& name, int sweeps) {
        return put(name, level2::wire::ldm_volume(sweeps, 360));
    };
    const fs::path one = write_file("KTLX_one", 2), other = write_file("KTLX_other", 3);
    fs::last_write_time(one, fs::file_time_type::clock::now() - std::chrono::hours(1));
    const auto again = [&](const fs::path& path) {
        const auto outcome = ingestor_.ingest_again(path);
        EXPECT_EQ(outcome->result(), IngestResult::gridded);
        return only_grid("KTLX").provenance.sweeps.size();
    };
    ASSERT_TRUE(ingestor_.ingest(one, false));
    ASSERT_TRUE(ingestor_.ingest(other, false));
    const std::size_t counts = only_grid("KTLX").provenance.sweeps.size();
    for (const fs::path& path : {one, other, one})
        EXPECT_EQ(again(path), counts);
    const auto reason = ingestor_.ingest_again(counts == 2 ? other : one)->reason;
    EXPECT_EQ(reason, "not replaced: the cache has a grid of another file of this volume");

    const auto [kept, left] = counts == 2 ? std::pair{one, other} : std::pair{other, one};
    fs::remove(kept);
    EXPECT_NE(again(left), counts) << "without the deleted file, the other file counts";
    write_file(kept.filename(), counts == 2 ? 2 : 3);
    EXPECT_EQ(again(kept), counts);
}

// Each volume of a file is judged separately. Here, only the first volume is incomplete.
TEST_F(IngestTest, OfTwoVolumesOnlyTheOneThatBrokeOffIsPartial) {
    const auto second = level2::wire::ldm_volume(2, 360);
    auto messages = level2::wire::radial_messages(3, 360);
    messages.resize(messages.size() / 2);
    const auto first = level2::wire::ldm_record(messages);
    auto header = level2::wire::archive_header();
    level2::wire::overwrite_u32(header, 16, 1'800'000);
    const auto outcome =
        ingestor_.ingest(put("KTLX_two", level2::wire::join({header, first, second})), true);
    ASSERT_TRUE(outcome) << outcome.error().message;
    EXPECT_TRUE(outcome->partial);
    ASSERT_EQ(outcome->grids.size(), 2U);
    const auto partial = [](const fs::path& path) {
        return cache::GridFile::open(path)->description().provenance.partial;
    };
    EXPECT_TRUE(partial(outcome->grids[0]));
    EXPECT_FALSE(partial(outcome->grids[1]));
}

// A retry cannot help if the file itself is to blame.
TEST_F(IngestTest, ImpossibleDatesAreNoReasonToTryForEver) {
    auto header_only = level2::wire::ldm_volume(2, 360);
    level2::wire::overwrite_u32(header_only, 12, 0x10000000);
    const auto by_radials = ingestor_.ingest(put("KTLX_a", header_only), false);
    ASSERT_TRUE(by_radials) << by_radials.error().message;
    EXPECT_EQ(by_radials->result(), IngestResult::gridded);
    EXPECT_EQ(format_utc(*by_radials->volume_time).substr(0, 10), "2022-03-17");
    EXPECT_NE(by_radials->reason, "") << "the outcome must give a reason";
}

TEST_F(IngestTest, AFileThatCouldNotBeReadIsReadWhenItCan) {
    if (::geteuid() == 0) GTEST_SKIP() << "root can read every file";
    const fs::path path = put("KTLX_a", level2::wire::ldm_volume(2, 360));
    fs::permissions(path, fs::perms::none);
    const auto refused = ingestor_.ingest(path, false);
    ASSERT_TRUE(refused);
    EXPECT_EQ(refused->result(), IngestResult::rejected);
    EXPECT_NE(refused->reason.find("ermission"), std::string::npos);
    fs::permissions(path, fs::perms::owner_read);
    EXPECT_EQ(ingestor_.ingest(path, false)->result(), IngestResult::gridded);
}

TEST_F(IngestTest, FileThatIsGoneIsMarkedSo) {
    const fs::path path = write("KTLX_nonsense", std::string(5000, 'x'));
    ASSERT_TRUE(ingestor_.ingest(path, false));
    fs::remove(path);
    EXPECT_EQ(ingestor_.ingest(path, false)->result(), IngestResult::vanished);
    EXPECT_EQ(only_entry("KTLX").state, FileState::gone);
}

// 2026-11-30: a volume whose KDP alone was wanted was rejected as too large, because the limit
// counted a single moment.
TEST_F(IngestTest, KdpAloneMayComeFromAVolumeWhoseMomentsTakeMoreThanOneShould) {
    STORMCELLAR_NEED_DATA();
    IngestOptions options = small_grid();
    options.moments = {Moment::kdp};
    EXPECT_EQ(decoded_for({Moment::ref}, 0).moments, std::vector{Moment::ref});
    EXPECT_TRUE(decoded_for({Moment::ref}, 0.5).moments.empty());
    Ingestor ingestor(catalog_, store_, options);
    const auto outcome =
        ingestor.ingest(testing::real_file("volumes/KLOT20220317_000842_V06"), false);
    ASSERT_TRUE(outcome) << outcome.error().message;
    EXPECT_EQ(outcome->result(), IngestResult::gridded) << outcome->reason;
    EXPECT_EQ(store_.list("KLOT", Moment::kdp, std::nullopt, std::nullopt)->size(), 1U);
}

class DerivedIngestTest : public SmallHouse {
  protected:
    DerivedIngestTest() : SmallHouse(options()) {}
    static IngestOptions options() {
        IngestOptions options = small_grid();
        options.moments = {level2::Moment::ref, level2::Moment::srv};
        return options;
    }
};

TEST_F(DerivedIngestTest, AGridOfTheStormRelativeVelocityKnowsItsMotion) {
    STORMCELLAR_NEED_DATA();
    const auto outcome =
        ingestor_.ingest(testing::real_file("volumes/KTLX19990503_235621.gz"), false);
    ASSERT_TRUE(outcome) << outcome.error().message;
    EXPECT_EQ(outcome->grids.size(), 2U);
    const auto entries =
        store_.list("KTLX", level2::Moment::srv, std::nullopt, std::nullopt).value();
    ASSERT_EQ(entries.size(), 1U);
    const auto file = cache::GridFile::open(entries.front().path);
    ASSERT_TRUE(file);
    const auto motion = retrieve::motion_in_notes(file->description().provenance.notes);
    ASSERT_TRUE(motion);
    // The storms of that day moved from the southwest.
    EXPECT_GT(motion->u_mps, 5);
    EXPECT_GT(motion->v_mps, 5);
}

TEST_F(DerivedIngestTest, AVolumeWithoutAMotionKeepsItsOtherGridsAndSaysWhy) {
    STORMCELLAR_NEED_DATA();
    const auto outcome =
        ingestor_.ingest(testing::real_file("sequence-kbgm/KBGM20050822_024414.gz"), false);
    ASSERT_TRUE(outcome) << outcome.error().message;
    EXPECT_EQ(outcome->result(), IngestResult::gridded);
    EXPECT_EQ(outcome->grids.size(), 1U);
    EXPECT_TRUE(outcome->reason.starts_with("no grid of SRV: the wind profile gives no storm"))
        << outcome->reason;
}

}  // namespace
}  // namespace stormcellar::pipeline
