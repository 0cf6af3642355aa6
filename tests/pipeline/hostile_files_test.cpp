// Tests malicious files: links to other places, names that are swapped, and sizes beyond those of
// all volumes.
#include <array>
#include <fstream>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "pipeline/ingest/followed_file.h"
#include "pipeline/ingest/ingest.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/cache/store.h"
#include "tests/level2/wire.h"
#include "tests/testing/file_bytes.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::pipeline {
namespace {

namespace wire = level2::wire;

class Hostile : public ::testing::Test {
  protected:
    Hostile() {
        fs::create_directories(drop());
        fs::create_directories(outside());
    }
    [[nodiscard]] fs::path drop() const { return directory_ / "drop"; }
    [[nodiscard]] fs::path outside() const { return directory_ / "outside"; }
    static fs::path put(const fs::path& path, std::span<const std::byte> bytes) {
        fs::create_directories(path.parent_path());
        testing::write_bytes(path, bytes);
        return path;
    }
    IngestOptions options() {
        IngestOptions made;
        made.spacing_m = 4000;
        made.nx = made.ny = 115;
        made.beneath = drop();
        made.living.scratch = directory_.path();
        made.living.chunk_grace = std::chrono::seconds{0};
        return made;
    }
    // Ingests a file and returns its result, such as "rejected: REASON".
    std::string take(const fs::path& path, bool finish_as_is = true) {
        const auto outcome = ingestor_.ingest(path, finish_as_is);
        if (!outcome) return "error: " + outcome.error().message;
        switch (outcome->result()) {
            case IngestResult::rejected:
                return "rejected: " + outcome->reason;
            case IngestResult::vanished:
                return "vanished";
            case IngestResult::incomplete:
                return "incomplete";
            case IngestResult::gridded:
                return "gridded";
            default:
                return "other";
        }
    }
    std::size_t rows() {
        std::size_t count = 0;
        const auto stations = catalog_.stations();
        for (const auto& station : *stations)
            count += catalog_.list(station.station, {std::nullopt, std::nullopt, true})->size();
        return count;
    }
    testing::TemporaryDirectory directory_;
    catalog::CatalogWriter catalog_ = *catalog::CatalogWriter::open(directory_ / "catalog");
    cache::StoreWriter store_ =
        *cache::StoreWriter::open(real_file_system(), directory_ / "cache", true);
    Ingestor ingestor_{catalog_, store_, options()};
};

TEST_F(Hostile, AnOrdinaryFileIsTaken) {
    EXPECT_EQ(take(put(drop() / "day/KTLX_a", wire::ldm_volume(2, 360))), "gridded");
}

// The names stay the same, but now lead to other files.
TEST_F(Hostile, ADirectoryThatBecomesALinkLeadsNowhere) {
    const auto bytes = wire::ldm_volume(2, 360);
    put(outside() / "KTLX_a", bytes);
    fs::create_directory_symlink(outside(), drop() / "day");
    EXPECT_EQ(take(drop() / "day/KTLX_a"), "vanished");
    EXPECT_EQ(take(drop() / "day/KTLX_a", false), "vanished");
    EXPECT_EQ(rows(), 0U);
}

TEST_F(Hostile, APathThatLeadsOutIsNotThere) {
    put(outside() / "KTLX_a", wire::ldm_volume(2, 360));
    EXPECT_EQ(take(outside() / "KTLX_a"), "vanished");
    EXPECT_EQ(take(drop() / "../outside/KTLX_a"), "vanished");
    EXPECT_EQ(rows(), 0U);
}

TEST_F(Hostile, AGrowingFileBehindALinkIsNotFollowed) {
    const auto bytes = wire::join({wire::archive_header(), {}});
    put(outside() / "KTLX_a", bytes);
    EXPECT_TRUE(FollowedFile::growing(outside() / "KTLX_a"));
    EXPECT_FALSE(FollowedFile::growing(outside() / "KTLX_a", drop()));
    fs::create_symlink(outside() / "KTLX_a", drop() / "KTLX_a");
    EXPECT_FALSE(FollowedFile::growing(drop() / "KTLX_a", drop()));
    fs::create_directory_symlink(outside(), drop() / "day");
    EXPECT_FALSE(FollowedFile::growing(drop() / "day/KTLX_a", drop()));
}

// Returns two records with one sweep each. The first record does not end the volume.
std::array<wire::Bytes, 2> two_records() {
    const auto messages = wire::radial_messages(2, 360);
    const std::span all{messages};
    return {wire::ldm_record(all.first(all.size() / 2)),
            wire::ldm_record(all.subspan(all.size() / 2), true)};
}

// The other chunks of a volume are found by their names, but links are never chunks.
TEST_F(Hostile, LinksAmongChunksAreNotRead) {
    const auto [first, last] = two_records();
    put(drop() / "KTLX/1/20220317-000842-001-S", wire::join({wire::archive_header(), first}));
    put(outside() / "chunk", last);
    fs::create_symlink(outside() / "chunk", drop() / "KTLX/1/20220317-000842-002-E");
    EXPECT_EQ(take(drop() / "KTLX/1/20220317-000842-001-S", false), "incomplete")
        << "the linked second chunk would end the volume";
    EXPECT_EQ(take(drop() / "KTLX/1/20220317-000842-002-E"), "rejected: is a symbolic link");
}

constexpr std::uintmax_t tebibyte = std::uintmax_t{1} << 40U;

// Huge files are rejected by their size, so that nobody reads a tebibyte of zeros.
TEST_F(Hostile, HugeSparseFilesAreRefusedUnread) {
    const std::string why =
        "rejected: has 1099511627776 bytes, more than the 268435456 that a raw file may have; it "
        "was not read";
    const auto record = wire::ldm_record(wire::radial_messages(1, 360));
    const auto begun = wire::join({wire::archive_header(), record});
    for (const char* name : {"plain", "KTLX20220317_000842_V06", "KTLX/1/20220317-000842-001-S"}) {
        const fs::path path = put(drop() / name, begun);
        fs::resize_file(path, tebibyte);
        EXPECT_EQ(take(path, false), why) << name;
        EXPECT_EQ(ingestor_.ingest_again(path)->reason, why.substr(10)) << name;
    }
}

// 2026-11-25: a file of 61 kB had 16,389 volumes and took a minute.
TEST_F(Hostile, AFileOfManyVolumesIsRefused) {
    const wire::Bytes one = wire::ldm_volume(1, 4);
    wire::Bytes many;
    for (int i = 0; i < 65; ++i)
        many.insert(many.end(), one.begin(), one.end());
    EXPECT_EQ(take(put(drop() / "KTLX_many", many)),
              "rejected: holds 65 volumes, more than the 64 that a raw file may hold");
    many.resize(many.size() - one.size());
    EXPECT_EQ(take(put(drop() / "KTLX_fewer", many)), "gridded");
}

// 2026-11-25: 3,000 volumes of one station displaced nearly all grids of the other stations.
TEST_F(Hostile, AStationHasNoMoreGridsOfAnHourThanARadarMakes) {
    wire::Bytes bytes = wire::ldm_volume(1, 4);
    const auto set_second = [&](std::uint32_t second) {
        wire::Bytes time = wire::Writer{}.u32(1000 * second).bytes;
        std::copy(time.begin(), time.end(), bytes.begin() + 16);
    };
    for (std::uint32_t i = 0; i < 130; ++i) {
        set_second(10 * i);
        ASSERT_EQ(take(put(drop() / ("KTLX_" + std::to_string(i)), bytes)), "gridded") << i;
    }
    const auto grids = store_.list("KTLX", level2::Moment::ref, std::nullopt, std::nullopt);
    ASSERT_TRUE(grids);
    EXPECT_EQ(grids->size(), 120U);
    EXPECT_EQ(grids->back().time - grids->front().time, std::chrono::seconds{1190})
        << "the grids that were written first should be removed";
}

// 2026-11-25: when a followed file had grown to 1 GiB of zeros, all of it was read in one go,
// twice.
TEST_F(Hostile, AFollowedFileThatGrowsAsItEndsIsReadNoFurther) {
    const wire::Bytes whole = wire::ldm_volume(3, 360);
    const fs::path path = put(drop() / "KTLX_grows", whole);
    FollowedFile::Options follow;
    follow.scratch = directory_.path();
    auto file = FollowedFile::begin(path, follow);
    ASSERT_TRUE(file);
    ASSERT_TRUE((*file)->read_to(whole.size()));
    fs::resize_file(path, (std::uintmax_t{1} << 40) - 1);
    const auto finished = (*file)->finish();
    ASSERT_FALSE(finished);
    EXPECT_EQ(finished.error().code, ErrorCode::corrupt);
}

TEST_F(Hostile, AFollowedFileThatBecomesHugeIsGivenUp) {
    const auto record = two_records()[0];
    const fs::path path =
        put(drop() / "KTLX20220317_000842_V06", wire::join({wire::archive_header(), record}));
    EXPECT_EQ(take(path, false), "incomplete");
    fs::resize_file(path, tebibyte);
    EXPECT_TRUE(take(path, false).starts_with("rejected: has 1099511627776 bytes"));
}

// Returns a file in which each of the records, of 90 bytes, unpacks to 45 MB.
wire::Bytes bomb(unsigned records) {
    const auto messages = wire::radial_messages(1, 1);
    wire::Bytes stream = wire::bzip2(wire::Bytes(45'000'000));
    wire::Bytes file = wire::join({wire::archive_header(), wire::ldm_record(messages)});
    const auto record =
        wire::Writer{}.u32(static_cast<std::uint32_t>(stream.size())).raw(stream).bytes;
    for (unsigned i = 0; i < records; ++i)
        file.insert(file.end(), record.begin(), record.end());
    return file;
}

TEST_F(Hostile, WhatUnpacksToMoreThanAnyVolumeIsRejected) {
    const auto file = bomb(12);
    EXPECT_LT(file.size(), 10'000U);
    const std::string rejected = take(put(drop() / "KTLX_bomb", file));
    EXPECT_TRUE(rejected.starts_with("rejected: ")) << rejected;
    EXPECT_NE(rejected.find("limit"), std::string::npos) << rejected;
    const std::string packed = take(put(drop() / "KTLX_packed", wire::gzip(file)));
    EXPECT_TRUE(packed.starts_with("rejected: ")) << packed;
}

}  // namespace
}  // namespace stormcellar::pipeline
