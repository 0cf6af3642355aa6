// Tests archives in the drop directory, whose members are ingested like single files.
#include <fstream>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "base/checksum.h"
#include "catalog/check_catalog.h"
#include "pipeline/care/mend_cache.h"
#include "pipeline/drop/station_place.h"
#include "pipeline/ingest/ingest.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/base/member_name.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/catalog/read_cataloged.h"
#include "tests/archive/archive_maker.h"
#include "tests/pipeline/small_house.h"
#include "tests/testing/file_bytes.h"

namespace stormcellar::pipeline {
namespace {

using catalog::CatalogEntry;
using catalog::FileState;
using ::testing::HasSubstr;

class IngestArchiveTest : public SmallHouse {
  protected:
    void SetUp() override { STORMCELLAR_NEED_DATA(); }
    static std::vector<std::byte> real(const std::string& name) {
        return read_file(testing::real_file("sequence-kbgm") / name).value();
    }
    static std::vector<archive::Put> two_volumes() {
        return {{"order/KBGM20050822_024414.gz", real("KBGM20050822_024414.gz")},
                {"order/README", archive::bytes_of("two volumes")},
                {"order/KBGM20050822_025549.gz", real("KBGM20050822_025549.gz")}};
    }
    fs::path put(const std::string& name, const std::vector<std::byte>& bytes) {
        testing::write_bytes(directory_ / name, bytes);
        return directory_ / name;
    }
    fs::path put_two_volumes() {
        return put("order.tar", archive::make_archive(archive::Kind::tar, two_volumes()));
    }
    static IngestOptions one_member_a_turn() {
        IngestOptions options = small_grid();
        options.archive_turn = std::chrono::milliseconds{0};
        return options;
    }
    std::vector<CatalogEntry> volumes() { return catalog_.list("KBGM", {}).value(); }
    std::size_t grid_count() { return grids("KBGM").size(); }
};

TEST_F(IngestArchiveTest, ItsVolumesAreGriddedAndCatalogedByTheirNames) {
    for (const archive::Kind kind : {archive::Kind::tar, archive::Kind::zip}) {
        const fs::path path = put("order.bin", archive::make_archive(kind, two_volumes()));
        const auto outcome = ingestor_.ingest(path, false);
        ASSERT_TRUE(outcome) << outcome.error().message;
        EXPECT_EQ(grid_count(), 2U);
        ASSERT_EQ(volumes().size(), 2U);
        EXPECT_EQ(volumes()[0].path, member_path(path, "order/KBGM20050822_024414.gz"));
        EXPECT_EQ(volumes()[0].state, FileState::complete);
        EXPECT_THAT(outcome->reason, HasSubstr(kind == archive::Kind::tar ? "2 ingested, 1 rejected"
                                                                          : "3 already known"));
    }
    EXPECT_EQ(ingestor_.ingest(directory_ / "order.bin", false)->result(), IngestResult::unchanged);
}

TEST_F(IngestArchiveTest, AMemberIsReadAgainFromItsArchive) {
    const fs::path path =
        put("order.zip", archive::make_archive(archive::Kind::zip, two_volumes()));
    ASSERT_TRUE(ingestor_.ingest(path, false));
    const auto raw = catalog::read_cataloged(catalog_, volumes()[1]);
    ASSERT_TRUE(raw) << raw.error().message;
    EXPECT_TRUE(raw->bytes == real("KBGM20050822_025549.gz"));
    const auto again = ingestor_.ingest_again(volumes()[1].path);
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_EQ(again->result(), IngestResult::gridded);
    // Another member in the place of the cataloged member is refused.
    auto others = two_volumes();
    others[2].bytes = real("KBGM20050822_024414.gz");
    put("order.zip", archive::make_archive(archive::Kind::zip, others));
    const auto changed = catalog::read_cataloged(catalog_, volumes()[1]);
    ASSERT_FALSE(changed);
    EXPECT_EQ(changed.error().code, ErrorCode::corrupt);
}

// 2026-11-28: the second member was not found, because the larger first member was skipped without
// being counted.
TEST_F(IngestArchiveTest, TheSecondMemberOfANameIsReadAgain) {
    const auto larger = real("KBGM20050822_024414.gz"), smaller = real("KBGM20050822_025549.gz");
    ASSERT_GT(larger.size(), smaller.size());
    const std::vector<archive::Put> twins = {{"KBGM.gz", larger}, {"KBGM.gz", smaller}};
    ASSERT_TRUE(ingestor_.ingest(put("order.tar", archive::make_archive(archive::Kind::tar, twins)),
                                 false));
    ASSERT_EQ(volumes().size(), 2U);
    const auto raw = catalog::read_cataloged(catalog_, volumes()[1]);
    ASSERT_TRUE(raw) << raw.error().message;
    EXPECT_TRUE(raw->bytes == smaller);
}

// 2026-11-29: the check reported each member as missing.
TEST_F(IngestArchiveTest, ACatalogWithMembersIsSound) {
    const fs::path path = put_two_volumes();
    ASSERT_TRUE(ingestor_.ingest(path, false));
    const auto check = catalog::check_catalog(directory_ / "catalog", "");
    ASSERT_TRUE(check) << check.error().message;
    EXPECT_TRUE(check->is_sound());
    fs::remove(path);
    EXPECT_FALSE(catalog::check_catalog(directory_ / "catalog", "")->is_sound());
}

// 2026-11-29: the rows of members of the replaced archive stayed `complete`.
TEST_F(IngestArchiveTest, MembersOfAnArchiveThatWasReplacedAreGone) {
    auto members = two_volumes();
    ASSERT_TRUE(ingestor_.ingest(
        put("last.tar", archive::make_archive(archive::Kind::tar, members)), false));
    ASSERT_EQ(volumes().size(), 2U);
    members.erase(members.begin());
    ASSERT_TRUE(ingestor_.ingest(
        put("last.tar", archive::make_archive(archive::Kind::tar, members)), false));
    EXPECT_EQ(volumes().at(0).state, FileState::gone);
    EXPECT_EQ(volumes().at(1).state, FileState::complete);
}

// 2026-11-29: because the archive was settled, lost rows of its members were never made again.
TEST_F(IngestArchiveTest, RowsOfMembersThatWereLostAreMadeAgain) {
    const fs::path path = put_two_volumes();
    ASSERT_TRUE(ingestor_.ingest(path, false));
    fs::remove(directory_ / "catalog" / "KBGM.sqlite");
    EXPECT_FALSE(catalog_.list("KBGM", {})) << "this query notices the lost database";
    EXPECT_EQ(ingestor_.ingest(path, false)->result(), IngestResult::unchanged);
    ASSERT_EQ(catalog_.take_repairs().size(), 1U);
    const auto again = ingestor_.ingest(path, false);
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_EQ(volumes().size(), 2U);
}

// 2026-11-28: the log said that the raw file was gone or had changed.
TEST_F(IngestArchiveTest, AGridOfAMemberIsNotMadeAgain) {
    ASSERT_TRUE(ingestor_.ingest(put_two_volumes(), false));
    const auto grid = grids("KBGM").at(0);
    fs::resize_file(grid.path, 5000);
    CacheMender mender(catalog_, store_, ingestor_, {level2::Moment::ref});
    const auto mended = mender.mend(grid, MendDepth::header);
    ASSERT_TRUE(mended) << mended.error().message;
    EXPECT_EQ(mended->condition, GridCondition::dropped);
    EXPECT_THAT(mended->why_not, HasSubstr("member of an archive"));
}

TEST_F(IngestArchiveTest, OneThatIsStillBeingWrittenIsWaitedFor) {
    auto bytes = archive::make_archive(archive::Kind::tar, two_volumes());
    const std::size_t whole = bytes.size();
    const auto all = bytes;
    bytes.resize(whole - 300'000);
    const fs::path path = put("order.tar", bytes);
    EXPECT_EQ(ingestor_.ingest(path, false)->result(), IngestResult::incomplete);
    EXPECT_EQ(grid_count(), 0U);
    put("order.tar", all);
    EXPECT_EQ(ingestor_.ingest(path, false)->result(), IngestResult::gridded);
    EXPECT_EQ(grid_count(), 2U);
}

TEST_F(IngestArchiveTest, OfOneThatStaysCutWhatIsWholeIsTaken) {
    auto bytes = archive::make_archive(archive::Kind::tar, two_volumes());
    bytes.resize(bytes.size() - 300'000);
    const auto outcome = ingestor_.ingest(put("order.tar", bytes), true);
    ASSERT_TRUE(outcome);
    EXPECT_EQ(outcome->result(), IngestResult::gridded);
    EXPECT_EQ(grid_count(), 1U);
    EXPECT_THAT(outcome->reason, HasSubstr("cut or damaged"));
}

TEST_F(IngestArchiveTest, ALongOneIsTakenInByTurns) {
    Ingestor by_turns(catalog_, store_, one_member_a_turn());
    const fs::path path = put_two_volumes();
    EXPECT_EQ(by_turns.ingest(path, false)->result(), IngestResult::incomplete);
    EXPECT_EQ(grid_count(), 1U);
    int turns = 1;
    while (by_turns.ingest(path, true)->result() == IngestResult::incomplete && turns < 10)
        ++turns;
    EXPECT_EQ(turns, 3) << "a member without a volume takes a turn, too";
    EXPECT_EQ(grid_count(), 2U);
    EXPECT_EQ(by_turns.ingest(path, true)->result(), IngestResult::unchanged);
}

// 2026-11-29: after a temporary read error, no later member was ever ingested.
TEST_F(IngestArchiveTest, OneThatCannotBeReadForNowIsNotSettled) {
    Ingestor by_turns(catalog_, store_, one_member_a_turn());
    const fs::path path = put_two_volumes();
    EXPECT_EQ(by_turns.ingest(path, true)->result(), IngestResult::incomplete);
    // Reading from a descriptor for writing fails.
    const Descriptor unreadable{::open("/dev/null", O_WRONLY | O_CLOEXEC)};
    for (const auto& entry : fs::directory_iterator("/proc/self/fd")) {
        std::error_code gone;
        if (fs::read_symlink(entry, gone) == path)
            ::dup2(unreadable.number(), std::stoi(entry.path().filename()));
    }
    auto outcome = by_turns.ingest(path, true);
    while (outcome && outcome->result() == IngestResult::incomplete)
        outcome = by_turns.ingest(path, true);
    ASSERT_FALSE(outcome) << outcome->reason;
    EXPECT_EQ(outcome.error().code, ErrorCode::io);
    Ingestor later(catalog_, store_, small_grid());
    EXPECT_EQ(later.ingest(path, true)->result(), IngestResult::gridded);
    EXPECT_EQ(grid_count(), 2U);
}

// 2026-11-28: of five waiting archives, each was closed before its next turn, so no archive made
// progress.
TEST_F(IngestArchiveTest, ManyLongOnesComeToTheirEnds) {
    Ingestor by_turns(catalog_, store_, one_member_a_turn());
    std::vector<fs::path> waiting;
    for (int i = 0; i < 5; ++i)
        waiting.push_back(put(fmt::format("order{}.tar", i),
                              archive::make_archive(archive::Kind::tar, two_volumes())));
    for (int round = 0; round < 8; ++round) {
        std::erase_if(waiting, [&](const fs::path& path) {
            return by_turns.ingest(path, true)->result() != IngestResult::incomplete;
        });
    }
    EXPECT_TRUE(waiting.empty());
    EXPECT_EQ(grid_count(), 2U);
}

TEST_F(IngestArchiveTest, APackedOneIsTakenToo) {
    Ingestor by_turns(catalog_, store_, one_member_a_turn());
    for (const auto kind : {archive::Kind::tar_gz, archive::Kind::tar_bz2}) {
        const fs::path path = put("order.tar.packed", archive::make_archive(kind, two_volumes()));
        int turns = 1;
        for (; turns < 10; ++turns) {
            const auto outcome = by_turns.ingest(path, true);
            ASSERT_TRUE(outcome);
            if (outcome->result() != IngestResult::incomplete) break;
            EXPECT_TRUE(std::get<ended::Incomplete>(outcome->ending).has_next_turn);
        }
        EXPECT_EQ(turns, 4) << "three members and the end take a turn each";
        EXPECT_EQ(grid_count(), 2U);
        fs::remove(path);
    }
}

TEST_F(IngestArchiveTest, ItsRowsAreGoneWhenItIs) {
    const fs::path path = put_two_volumes();
    ASSERT_TRUE(ingestor_.ingest(path, false));
    EXPECT_EQ(catalog_.mark_missing(directory_.path()).value(), 0);
    fs::remove(path);
    EXPECT_GE(catalog_.mark_missing(directory_.path()).value(), 2);
    EXPECT_EQ(volumes()[0].state, FileState::gone);
}

TEST_F(IngestArchiveTest, AFileWithAMarkInItsNameIsAFile) {
    const fs::path path = put("KBGM!20050822", real("KBGM20050822_024414.gz"));
    EXPECT_EQ(ingestor_.ingest(path, false)->result(), IngestResult::gridded);
    EXPECT_EQ(volumes().at(0).path, path);
}

TEST_F(IngestArchiveTest, AStationOfNoTableStandsWhereItsFilesSay) {
    const auto place = place_of_station(catalog_, "KTLX");
    ASSERT_TRUE(place);
    EXPECT_NEAR(place->latitude_deg, 35.33, 0.01);
    EXPECT_FALSE(place_of_station(catalog_, "NOP4"));
    const fs::path file = testing::real_file("cases/1-segfault-center/drop");
    if (!fs::exists(file)) GTEST_SKIP() << "no cases beside the real volumes";
    ASSERT_TRUE(ingestor_.ingest(file / "NOP420170101_030027_V06", true));
    const auto found = place_of_station(catalog_, "NOP4");
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->latitude_deg, 35.24, 0.01);
}

}  // namespace
}  // namespace stormcellar::pipeline
