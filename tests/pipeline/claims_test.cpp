// Tests files that make false claims about their station, their time or their size.
#include <algorithm>
#include <fstream>

#include <gtest/gtest.h>

#include "pipeline/ingest/followed_files.h"
#include "pipeline/ingest/ingest.h"
#include "stormcellar/cache/store.h"
#include "tests/level2/wire.h"
#include "tests/pipeline/small_house.h"
#include "tests/testing/file_bytes.h"

namespace stormcellar::pipeline {
namespace {

namespace wire = level2::wire;
using catalog::FileState;

// Returns the messages with another station in place of the synthetic one.
wire::Bytes said_by(wire::Bytes messages, std::string_view station) {
    constexpr std::string_view usual = "KTLX";
    const auto as_byte = [](char c) { return static_cast<std::byte>(c); };
    for (std::size_t i = 0; i + usual.size() <= messages.size(); ++i) {
        const auto at = messages.begin() + static_cast<std::ptrdiff_t>(i);
        if (std::equal(usual.begin(), usual.end(), at,
                       [&](char c, std::byte b) { return as_byte(c) == b; })) {
            std::transform(station.begin(), station.end(), at, as_byte);
        }
    }
    return messages;
}

wire::Bytes volume_of(std::string_view station, unsigned sweeps = 2) {
    const wire::Bytes messages = said_by(wire::radial_messages(sweeps, 360), station);
    return wire::join(
        {wire::archive_header("AR2V0006.116", station), wire::ldm_record(messages, true)});
}

// Returns a sweep that never ends. Each record has a megabyte of gates, which is packed to a
// kilobyte.
wire::Bytes endless_sweep(std::string_view station, std::size_t records) {
    wire::Bytes messages;
    for (unsigned i = 0; i < 50; ++i) {
        wire::Ray ray;
        ray.azimuth_number = i + 1;
        ray.azimuth_deg = static_cast<float>(i);
        ray.gates = 20'000;
        const wire::Bytes message = wire::message_31(ray);
        messages.insert(messages.end(), message.begin(), message.end());
    }
    const wire::Bytes record = wire::ldm_record(said_by(std::move(messages), station), false, 1);
    wire::Bytes file = wire::archive_header("AR2V0006.116", station);
    for (std::size_t i = 0; i < records; ++i)
        file.insert(file.end(), record.begin(), record.end());
    return file;
}

class Claims : public ::testing::Test {
  protected:
    Claims() { fs::create_directories(drop()); }
    [[nodiscard]] fs::path drop() const { return directory_ / "drop"; }
    fs::path put(const std::string& name, const wire::Bytes& bytes) {
        fs::create_directories((drop() / name).parent_path());
        testing::write_bytes(drop() / name, bytes);
        return drop() / name;
    }
    Ingestor& with(std::shared_ptr<StationRule> stations) {
        IngestOptions options = small_grid();
        options.stations = std::move(stations);
        options.beneath = drop();
        options.living.scratch = directory_.path();
        ingestor_.emplace(catalog_, store_, options);
        return *ingestor_;
    }
    std::vector<catalog::CatalogEntry> rows(const std::string& station) {
        const auto entries = catalog_.list(station, {std::nullopt, std::nullopt, true});
        return entries ? *entries : std::vector<catalog::CatalogEntry>{};
    }

    testing::TemporaryDirectory directory_;
    catalog::CatalogWriter catalog_ = *catalog::CatalogWriter::open(directory_ / "catalog");
    cache::StoreWriter store_ =
        *cache::StoreWriter::open(real_file_system(), directory_ / "cache", true);
    std::optional<Ingestor> ingestor_;
};

TEST_F(Claims, AFileOfAnotherStationIsCatalogedAndNotGridded) {
    Ingestor& ingestor = with(std::make_shared<StationRule>());
    const auto outcome = ingestor.ingest(put("KTLX20220317_010000", volume_of("XAAA")), false);
    ASSERT_TRUE(outcome) << outcome.error().message;
    EXPECT_EQ(outcome->result(), IngestResult::other_station);
    EXPECT_EQ(outcome->station, "");
    EXPECT_EQ(store_.domains()->size(), 0U);
    const auto entries = rows("");
    ASSERT_EQ(entries.size(), 1U);
    EXPECT_EQ(entries[0].state, FileState::complete);
    EXPECT_EQ(entries[0].volume.sweep_count, 2);
    EXPECT_TRUE(entries[0].reason.starts_with(
        "is of XAAA, a station that [ingest] stations does not accept"))
        << entries[0].reason;
    EXPECT_FALSE(fs::exists(directory_ / "catalog/XAAA.sqlite"));
    EXPECT_EQ(ingestor.ingest(drop() / "KTLX20220317_010000", false)->result(),
              IngestResult::unchanged);
}

TEST_F(Claims, AListLeavesOutWhatTheTableKnows) {
    Ingestor& ingestor = with(std::make_shared<StationRule>(StationRule::listed({"XAAA"})));
    EXPECT_EQ(ingestor.ingest(put("KTLX_a", volume_of("KTLX")), false)->result(),
              IngestResult::other_station);
    EXPECT_EQ(ingestor.ingest(put("any", volume_of("XAAA")), false)->result(),
              IngestResult::gridded);
    EXPECT_FALSE(fs::exists(directory_ / "catalog/KTLX.sqlite"));
    EXPECT_EQ(rows("XAAA").size(), 1U);
}

TEST_F(Claims, AnyTakesSoManyFurtherStations) {
    Ingestor& ingestor = with(std::make_shared<StationRule>(StationRule::any(2)));
    EXPECT_EQ(ingestor.ingest(put("a", volume_of("XAAA")), false)->result(), IngestResult::gridded);
    EXPECT_EQ(ingestor.ingest(put("b", volume_of("XBBB")), false)->result(), IngestResult::gridded);
    EXPECT_EQ(ingestor.ingest(put("c", volume_of("XCCC")), false)->result(),
              IngestResult::other_station);
    EXPECT_EQ(ingestor.ingest(put("d", volume_of("KTLX")), false)->result(), IngestResult::gridded);
    EXPECT_EQ(store_.domains(), (std::vector<std::string>{"KTLX", "XAAA", "XBBB"}));
}

// A growing file of an unknown station is not read again and again, because it has no living grid.
TEST_F(Claims, AGrowingFileOfAnotherStationIsReadWhenItIsQuiet) {
    Ingestor& ingestor = with(std::make_shared<StationRule>());
    const fs::path path = put("KTLX_a", endless_sweep("XAAA", 2));
    const auto outcome = ingestor.ingest(path, false);
    ASSERT_TRUE(outcome);
    EXPECT_EQ(outcome->result(), IngestResult::incomplete);
    EXPECT_FALSE(std::get<ended::Incomplete>(outcome->ending).is_followed);
    EXPECT_EQ(outcome->decode_s, 0);
    EXPECT_EQ(ingestor.ingest(path, true)->result(), IngestResult::other_station);
}

// 2026-11-25: a volume without a time was gridded at 1970-01-01.
TEST_F(Claims, AVolumeWithoutATimeIsNotGridded) {
    Ingestor& ingestor = with(nullptr);
    wire::Bytes header = wire::archive_header();
    wire::overwrite_u32(header, 12, 0);
    wire::Bytes messages = wire::radial_messages(2, 360);
    const wire::Bytes today = wire::Writer{}.u16(wire::day).bytes;
    for (std::size_t i = 0; i + 2 <= messages.size(); ++i) {
        if (std::equal(today.begin(), today.end(),
                       messages.begin() + static_cast<std::ptrdiff_t>(i)))
            wire::overwrite_u16(messages, i, 0);
    }
    const auto outcome = ingestor.ingest(
        put("KTLX_zero", wire::join({header, wire::ldm_record(messages, true)})), true);
    ASSERT_TRUE(outcome) << outcome.error().message;
    EXPECT_EQ(outcome->result(), IngestResult::rejected) << outcome->reason;
    EXPECT_EQ(store_.domains()->size(), 0U);
}

// If the results of a file cannot be stored, the file is tried again and, at the last try, rejected
// with the reason.
TEST_F(Claims, TheLastTryRejectsWhatCannotBeStored) {
    Ingestor& ingestor = with(nullptr);
    std::ofstream(directory_ / "cache/KTLX") << "something else stands where its grids should";
    const fs::path path = put("KTLX_a", volume_of("KTLX"));
    const auto failed = ingestor.ingest(path, false);
    ASSERT_FALSE(failed);
    EXPECT_EQ(failed.error().cause(), Cause::system);
    EXPECT_EQ(rows("KTLX").at(0).state, FileState::seen);
    const auto last = ingestor.ingest(path, false, Tries::last);
    ASSERT_TRUE(last) << last.error().message;
    EXPECT_EQ(last->result(), IngestResult::rejected);
    EXPECT_TRUE(last->reason.starts_with("given up: ")) << last->reason;
    EXPECT_EQ(rows("KTLX").at(0).state, FileState::rejected);
    // A file that is offered again, as after a restart, is tried again.
    fs::remove(directory_ / "cache/KTLX");
    EXPECT_EQ(ingestor.ingest(path, false)->result(), IngestResult::gridded);
    EXPECT_EQ(rows("KTLX").size(), 1U);
}

class LivingMemory : public Claims {
  protected:
    std::shared_ptr<FollowedFile> read(FollowedFiles& files, const fs::path& path,
                                       const std::string& station) {
        const auto file = files.begin(path, station, station);
        if (!file) return nullptr;
        const Status done =
            file->read_to(fs::file_size(path), [&] { return files.grew(path, *file, station); });
        EXPECT_TRUE(done || done.error().code == ErrorCode::over_budget) << done.error().message;
        return file;
    }
    FollowedFile::Options options_{
        {{level2::Moment::ref}, {}}, {level2::Moment::ref}, {}, directory_.path()};
};

// 2026-11-25: the memory of an open sweep did not count, and a hundred files with open sweeps took
// 5 GiB.
TEST_F(LivingMemory, AnOpenSweepCounts) {
    FollowedFiles files(options_, GrowingLimits{.station_held_bytes = std::uint64_t{64} << 20});
    const fs::path path = put("KTLX_a", endless_sweep("KTLX", 25));
    const auto file = read(files, path, "KTLX");
    ASSERT_TRUE(file);
    EXPECT_TRUE(file->is_whole());
    EXPECT_GT(file->growth().held_bytes, 24'000'000U);
    EXPECT_LT(file->growth().held_bytes, 40'000'000U);
    EXPECT_EQ(files.held_bytes(), file->growth().held_bytes);
}

TEST_F(LivingMemory, AnUnfinishedRecordCounts) {
    FollowedFiles files(options_);
    wire::Bytes bytes = wire::archive_header();
    wire::Bytes record = wire::Writer{}.u32(9'000'000).text("BZh91AY&SY").bytes;
    record.resize(4'000'000, std::byte{7});
    bytes.insert(bytes.end(), record.begin(), record.end());
    const auto file = read(files, put("KTLX_a", bytes), "KTLX");
    ASSERT_TRUE(file);
    EXPECT_GE(file->growth().held_bytes, 4'000'000U);
}

// The whole sweep comes in one stretch of some kilobytes.
TEST_F(LivingMemory, AnOpenSweepIsReadNoFurtherThanItsBound) {
    options_.open_sweep_limit_bytes = 6'000'000;
    FollowedFiles files(options_);
    const fs::path a = put("KTLX_a", endless_sweep("KTLX", 25));
    const auto file = files.begin(a, "KTLX", "KTLX");
    ASSERT_TRUE(file);
    const Status read = file->read_to(fs::file_size(a), {});
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().code, ErrorCode::over_budget);
    EXPECT_LT(file->growth().held_bytes, 12'000'000U);
    files.give_up(a);
    EXPECT_EQ(files.take_given_up(), 1U);
    EXPECT_EQ(files.count(), 0U);
    EXPECT_FALSE(files.begin(a, "KTLX", "KTLX"));
}

TEST_F(LivingMemory, BeyondItsStationsBoundAFileIsGivenUpAndNotFollowedAgain) {
    FollowedFiles files(options_, GrowingLimits{.station_held_bytes = 30'000'000});
    const fs::path a = put("KTLX_a", endless_sweep("KTLX", 25));
    const fs::path b = put("KTLX_b", endless_sweep("KTLX", 2));
    ASSERT_TRUE(read(files, a, "KTLX")->is_whole());
    EXPECT_TRUE(read(files, b, "KTLX")->is_whole());
    EXPECT_EQ(files.count(), 2U);
    const fs::path c = put("KTLX_c", endless_sweep("KTLX", 20));
    (void)read(files, c, "KTLX");
    EXPECT_LE(files.held_bytes(), 30'000'000U);
    EXPECT_FALSE(files.find(a)) << "the largest file should be given up";
    EXPECT_TRUE(files.find(b));
    EXPECT_TRUE(files.find(c));
    EXPECT_EQ(files.take_given_up(), 1U);
    EXPECT_FALSE(files.begin(a, "KTLX", "KTLX"));
    files.forget(a);
    EXPECT_TRUE(files.begin(a, "KTLX", "KTLX")) << "a new file of this name may be followed";
}

TEST_F(LivingMemory, BeyondTheBoundOfAllWhatNoStationClaimsGoesFirst) {
    FollowedFiles files(options_, GrowingLimits{.held_bytes = 40'000'000,
                                                .station_held_bytes = std::uint64_t{64} << 20});
    const fs::path a = put("KTLX_a", endless_sweep("KTLX", 20));
    const fs::path b = put("b", endless_sweep("XAAA", 10));
    const fs::path c = put("KOKX_c", endless_sweep("KOKX", 14));
    ASSERT_TRUE(read(files, a, "KTLX")->is_whole());
    ASSERT_TRUE(read(files, b, "")->is_whole());
    ASSERT_TRUE(read(files, c, "KOKX")->is_whole());
    EXPECT_FALSE(files.find(b))
        << "the file of an unknown station is given up first, although it is smaller";
    EXPECT_TRUE(files.find(a) && files.find(c));
}

// Nothing follows this file, so only its last radial shows that the volume has ended.
TEST_F(LivingMemory, AFileThatIsNotFollowedIsReadAtItsEnd) {
    Ingestor& ingestor = with(std::make_shared<StationRule>());
    const wire::Bytes messages = wire::radial_messages(2, 360);
    const wire::Bytes bytes =
        wire::join({wire::archive_header(), wire::ldm_record(messages, false)});
    const auto growing = FollowedFile::growing(put("KTLX_a", bytes));
    ASSERT_TRUE(growing);
    EXPECT_TRUE(FollowedFile::has_ended(drop() / "KTLX_a", *growing));
    const fs::path endless = put("KTLX_b", endless_sweep("KTLX", 1));
    ASSERT_TRUE(FollowedFile::growing(endless));
    EXPECT_FALSE(FollowedFile::has_ended(endless, *FollowedFile::growing(endless)));
    EXPECT_EQ(ingestor.ingest(drop() / "KTLX_a", false)->result(), IngestResult::gridded);
}

// A file that is read whole has a separate limit, far above the size of any volume.
TEST_F(LivingMemory, AVolumeWithoutEndIsRefusedWhenItIsReadWhole) {
    Ingestor& ingestor = with(nullptr);
    wire::Bytes bytes = endless_sweep("KTLX", 70);
    const auto outcome = ingestor.ingest(put("KTLX_a", bytes), true);
    ASSERT_TRUE(outcome) << outcome.error().message;
    EXPECT_EQ(outcome->result(), IngestResult::rejected) << outcome->reason;
}

}  // namespace
}  // namespace stormcellar::pipeline
