// Tests that chunks appear whole, under LDM's names, and within the limits of age and bytes.
#include "fetch/feed/feed_drop.h"

#include <fstream>

#include <gtest/gtest.h>

#include "tests/fetch/feed/chunk_bucket.h"
#include "tests/testing/power_cut_file_system.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::feed {
namespace {

namespace fs = std::filesystem;
using std::chrono::hours;
using std::chrono::minutes;

const UtcTime drop_now = *parse_utc("2026-11-28T12:00:00Z", {});

class Dropping : public ::testing::Test {
  protected:
    FeedDrop open(DropLimits limits = {hours{6}, 1'000'000}, UtcTime at = drop_now) {
        auto drop = FeedDrop::open(real_file_system(), root(), limits, at);
        EXPECT_TRUE(drop) << drop.error().message;
        return std::move(*drop);
    }
    [[nodiscard]] fs::path root() const { return directory_ / "drop"; }
    static ChunkKey key(const std::string& station, int volume, UtcTime time, int number) {
        return *parse_chunk_key(key_of(station, volume, time, number, number == 1 ? 'S' : 'I'),
                                time);
    }
    static void write(FeedDrop& drop, const ChunkKey& key, std::size_t size = 100) {
        const std::vector<std::byte> bytes(size, std::byte{7});
        const Status written = drop.write(key, bytes);
        EXPECT_TRUE(written) << written.error().message;
    }
    testing::TemporaryDirectory directory_;
};

TEST_F(Dropping, AChunkLiesWhereLdmPutsIt) {
    FeedDrop drop = open();
    const ChunkKey chunk = key("KTLX", 494, drop_now, 1);
    EXPECT_FALSE(drop.has(chunk, 100));
    write(drop, chunk);
    EXPECT_TRUE(drop.has(chunk, 100));
    EXPECT_FALSE(drop.has(chunk, 99)) << "the size differs";
    EXPECT_EQ(files_below(root()).begin()->first, "KTLX/494/20261128-120000-001-S");
    EXPECT_EQ(files_below(root()).size(), 1U);
}

TEST_F(Dropping, WhatWasWrittenIsKnownAgain) {
    {
        FeedDrop drop = open();
        for (int i = 0; i < 4; ++i)
            write(drop, key("KTLX", 997 + i > 999 ? i - 2 : 997 + i, drop_now + minutes{5 * i}, 1));
        write(drop, key("KFDR", 3, drop_now + hours{1}, 1));
    }
    FeedDrop drop = open();
    EXPECT_EQ(drop.bytes(), 5U * 16'384);
    EXPECT_EQ(drop.newest_of("KTLX", 2),
              (std::vector<VolumeId>{{drop_now + minutes{10}, 999}, {drop_now + minutes{15}, 1}}));
    EXPECT_TRUE(drop.newest_of("KVNX", 2).empty());
}

TEST_F(Dropping, OldVolumesAreRemovedAndNothingElse) {
    FeedDrop drop = open();
    for (int i = 1; i <= 3; ++i)
        write(drop, key("KTLX", 1, drop_now - hours{9}, i));
    write(drop, key("KTLX", 1, drop_now - hours{1}, 1));
    write(drop, key("KFDR", 5, drop_now - hours{8}, 1));
    write(drop, key("KTLX", 2, drop_now, 1));
    std::ofstream(root() / "KTLX/1/notes.txt") << "mine";
    EXPECT_EQ(drop.prune(drop_now), 2U);
    EXPECT_EQ(drop.bytes(), 2U * 16'384);
    std::vector<std::string> left;
    for (const auto& [name, contents] : files_below(root()))
        left.push_back(name);
    EXPECT_EQ(left, (std::vector<std::string>{"KTLX/1/20261128-110000-001-S", "KTLX/1/notes.txt",
                                              "KTLX/2/20261128-120000-001-S"}));
    EXPECT_FALSE(fs::exists(root() / "KFDR")) << "empty directories are removed, too";
}

TEST_F(Dropping, TheOldestGiveWayToTheLimitOfBytes) {
    FeedDrop drop = open({hours{6}, 100'000});
    for (int i = 0; i < 5; ++i)
        write(drop, key("KTLX", 10 + i, drop_now + minutes{i}, 1), 30'000);
    EXPECT_EQ(drop.prune(drop_now), 2U);
    EXPECT_EQ(drop.bytes(), 90'000U);
    EXPECT_FALSE(fs::exists(root() / "KTLX/11"));
    EXPECT_TRUE(fs::exists(root() / "KTLX/12"));
}

TEST_F(Dropping, ChunksOfOneByteAreBoundedToo) {
    FeedDrop drop = open({hours{6}, 100'000});
    for (int i = 1; i <= 20; ++i)
        write(drop, key("KTLX", i, drop_now + minutes{i}, 1), 1);
    EXPECT_EQ(drop.prune(drop_now + minutes{20}), 14U);
    EXPECT_EQ(files_below(root()).size(), 6U);
}

TEST_F(Dropping, AWrongClockRemovesNothing) {
    FeedDrop drop = open();
    write(drop, key("KTLX", 1, drop_now - hours{1}, 1));
    write(drop, key("KTLX", 2, drop_now, 1));
    EXPECT_EQ(drop.prune(drop_now + hours{24 * 400}), 0U) << "the clock is far ahead";
    EXPECT_EQ(drop.prune(drop_now - hours{24 * 400}), 0U) << "the clock is far behind";
}

TEST_F(Dropping, WhatAKilledWriterLeftIsSweptUp) {
    fs::create_directories(root() / "KTLX/494");
    std::ofstream(root() / "KTLX/494" / (std::string{temporary_prefix} + "x")) << "half of a chunk";
    std::ofstream(root() / "KTLX/494/.other") << "not ours";
    (void)open();
    EXPECT_EQ(files_below(root()).size(), 1U);
}

TEST_F(Dropping, AfterAPowerCutNoChunkIsThereInPart) {
    testing::PowerCutFileSystem disk;
    auto drop = FeedDrop::open(disk, root(), {hours{6}, 1'000'000}, drop_now);
    ASSERT_TRUE(drop);
    const std::vector<std::byte> bytes(100, std::byte{7});
    ASSERT_TRUE(drop->write(key("KTLX", 494, drop_now, 1), bytes));
    disk.power_cut();
    std::ofstream(root() / "KTLX/494/20261128-120000-002-I");  // empty, as after a power cut
    FeedDrop again = open();
    EXPECT_FALSE(again.has(key("KTLX", 494, drop_now, 1), 100)) << "the chunk is fetched again";
    EXPECT_TRUE(files_below(root()).empty());
}

TEST_F(Dropping, AChunkThatIsWrittenAgainIsCountedOnce) {
    FeedDrop drop = open();
    write(drop, key("KTLX", 494, drop_now, 1), 30'000);
    write(drop, key("KTLX", 494, drop_now, 1), 20'000);
    EXPECT_EQ(drop.bytes(), 20'000U);
}

TEST_F(Dropping, LinksAreNotFollowed) {
    fs::create_directories(directory_ / "elsewhere/494");
    std::ofstream(directory_ / "elsewhere/494/20200101-000000-001-S") << "not ours";
    fs::create_directories(root());
    fs::create_directory_symlink(directory_ / "elsewhere", root() / "KTLX");
    FeedDrop drop = open();
    EXPECT_EQ(drop.volumes(), 0U);
    EXPECT_EQ(drop.prune(drop_now), 0U);
    EXPECT_TRUE(fs::exists(directory_ / "elsewhere/494/20200101-000000-001-S"));
}

}  // namespace
}  // namespace stormcellar::feed
