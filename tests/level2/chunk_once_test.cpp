#include "level2/containers/chunk_once.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/level2/wire.h"

namespace stormcellar::level2 {
namespace {

using wire::Bytes;

Bytes once(const Bytes& bytes) {
    const auto part = chunk_once(bytes);
    return {part.begin(), part.end()};
}

TEST(ChunkOnce, TakesWhatWasAppendedAgainOnce) {
    const Bytes record = wire::ldm_record(wire::radial_messages(1, 30));
    const Bytes start = wire::join({wire::archive_header(), record});
    for (const Bytes& chunk : {record, start}) {
        const Bytes part{chunk.begin(), chunk.begin() + static_cast<long>(chunk.size() / 3)};
        EXPECT_EQ(once(chunk), chunk);
        EXPECT_EQ(once(wire::join({chunk, chunk})), chunk);
        EXPECT_EQ(once(wire::join({chunk, chunk, chunk})), chunk);
        EXPECT_EQ(once(wire::join({part, chunk})), chunk) << "pqact was killed while it wrote";
        EXPECT_EQ(once(wire::join({chunk, part})), chunk) << "pqact was killed at the second copy";
        EXPECT_EQ(once(wire::join({part, chunk, part})), chunk);
    }
}

TEST(ChunkOnce, LeavesEverythingElseAsItIs) {
    const Bytes volume = wire::ldm_volume(3, 20);
    EXPECT_EQ(once(volume), volume);
    Bytes other = wire::join({volume, volume});
    other[volume.size() + volume.size() / 2] ^= std::byte{1};
    EXPECT_EQ(once(other), other) << "the second copy differs";
    const Bytes zeros(10'000);
    EXPECT_EQ(once(zeros), zeros);
    EXPECT_TRUE(once({}).empty());
}

}  // namespace
}  // namespace stormcellar::level2
