#include "level2/containers/bzip2_stream.h"

#include <random>

#include <gtest/gtest.h>

#include "tests/level2/wire.h"

namespace stormcellar::level2 {
namespace {

wire::Bytes noise(std::size_t size) {
    std::minstd_rand random{42};
    wire::Bytes bytes(size);
    for (std::byte& b : bytes)
        b = static_cast<std::byte>(random() >> 8);
    return bytes;
}

wire::Bytes blocks_joined(std::span<const std::byte> stream,
                          std::vector<bunzip::Status>& statuses) {
    bunzip::Workspace workspace;
    BzipBlocks blocks{stream, workspace};
    wire::Bytes all;
    while (const auto block = blocks.next(std::size_t{1} << 30)) {
        statuses.push_back(block->status);
        all.insert(all.end(), block->data.begin(), block->data.end());
    }
    return all;
}

TEST(BzipBlocks, TogetherAreTheStream) {
    for (const int level : {1, 9}) {
        const wire::Bytes plain = noise(2'000'000);
        std::vector<bunzip::Status> statuses;
        EXPECT_EQ(blocks_joined(wire::bzip2(plain, level), statuses), plain);
        EXPECT_GE(statuses.size(), level == 1 ? 20U : 2U);
    }
}

TEST(BzipBlocks, GoOnOverStreamsOneBehindTheOther) {
    const wire::Bytes plain = noise(50'000);
    const wire::Bytes packed = wire::bzip2(plain);
    std::vector<bunzip::Status> statuses;
    EXPECT_EQ(blocks_joined(wire::join({packed, packed}), statuses), wire::join({plain, plain}));
}

// A flipped bit in the middle of a stream loses only the block that contains it, and never gives a
// wrong byte.
TEST(BzipBlocks, OnlyTheDamagedBlockIsLost) {
    const wire::Bytes plain = noise(450'000);
    const wire::Bytes packed = wire::bzip2(plain, 1);
    for (std::size_t at = 1000; at + 1000 < packed.size(); at += 9973) {
        wire::Bytes damaged = packed;
        damaged[at] ^= std::byte{0x10};
        bunzip::Workspace workspace;
        BzipBlocks blocks{damaged, workspace};
        std::size_t bad = 0;
        std::size_t searched = 0;
        while (const auto block = blocks.next(1 << 20)) {
            if (block->status != bunzip::Status::whole) {
                ++bad;
                continue;
            }
            const auto found = std::search(plain.begin() + static_cast<std::ptrdiff_t>(searched),
                                           plain.end(), block->data.begin(), block->data.end());
            ASSERT_NE(found, plain.end()) << at;
            searched = static_cast<std::size_t>(found - plain.begin()) + block->data.size();
        }
        EXPECT_EQ(bad, 1) << at;
    }
}

TEST(BzipBlocks, ACutStreamHasItsWholeBlocksAndNoEnd) {
    const wire::Bytes plain = noise(450'000);
    wire::Bytes packed = wire::bzip2(plain, 1);
    packed.resize(packed.size() / 2);
    bunzip::Workspace workspace;
    BzipBlocks blocks{packed, workspace};
    wire::Bytes all;
    bunzip::Status last = bunzip::Status::whole;
    while (const auto block = blocks.next(1 << 20)) {
        last = block->status;
        all.insert(all.end(), block->data.begin(), block->data.end());
    }
    EXPECT_EQ(last, bunzip::Status::corrupt);
    EXPECT_FALSE(blocks.ended());
    ASSERT_GT(all.size(), 100'000);
    EXPECT_TRUE(std::equal(all.begin(), all.end(), plain.begin()));
}

TEST(BzipBlocks, ABombIsTooLargeAndEndless) {
    const wire::Bytes bomb = wire::bzip2(wire::Bytes(50'000'000));
    bunzip::Workspace workspace;
    BzipBlocks blocks{bomb, workspace};
    const auto block = blocks.next(1'000'000);
    ASSERT_TRUE(block);
    EXPECT_EQ(block->status, bunzip::Status::too_large);
    EXPECT_TRUE(block->data.empty());
}

TEST(BzipBlocks, MarksWithoutBlocksEnd) {
    wire::Writer marks;
    for (int i = 0; i < 100'000; ++i)
        marks.u32(0x31415926).u16(0x5359);
    bunzip::Workspace workspace;
    BzipBlocks blocks{marks.bytes, workspace};
    int count = 0;
    while (blocks.next(1 << 20))
        ++count;
    EXPECT_EQ(count, BzipBlocks::max_bad_blocks);
}

TEST(FindBzip2, FindsStreamsOnly) {
    const wire::Bytes packed = wire::bzip2(noise(100));
    EXPECT_TRUE(is_bzip2(packed));
    EXPECT_FALSE(is_bzip2(wire::Writer{}.text("BZh9 is no stream").bytes));
    EXPECT_FALSE(is_bzip2({}));
    const wire::Bytes all = wire::join({wire::Writer{}.text("BBZh0BZBZh9xx").bytes, packed});
    EXPECT_EQ(find_bzip2(all, 0), 13);
    EXPECT_EQ(find_bzip2(all, 14), std::nullopt);
}

}  // namespace
}  // namespace stormcellar::level2
