#include "level2/chunk_name.h"

#include <gtest/gtest.h>

namespace stormcellar::level2 {
namespace {

TEST(ChunkName, IsReadWithWhatStandsAroundIt) {
    for (const char* name :
         {"20220317-000842-017-I", "KLOT-20220317-000842-017-I", "/ldm/KLOT/20220317-000842-017-I",
          "20220317-000842-017-I.bz2", "20220317-000842-017-I-V06", "20220317-000842-17-I"}) {
        const auto chunk = parse_chunk_name(name);
        ASSERT_TRUE(chunk) << name;
        EXPECT_EQ(chunk->volume, "20220317-000842");
        EXPECT_EQ(chunk->number, 17);
        EXPECT_EQ(chunk->kind, ChunkKind::intermediate);
        EXPECT_EQ(to_string(*chunk), "20220317-000842-017-I");
    }
    EXPECT_EQ(parse_chunk_name("20220317-000842-001-S")->kind, ChunkKind::start);
    EXPECT_EQ(parse_chunk_name("20220317-000842-055-E")->kind, ChunkKind::end);
}

TEST(ChunkName, OtherNamesAreNone) {
    for (const char* name :
         {"", "KLOT20220317_000842_V06", "20220317-000842-017-X", "20220317-000842-0017-I",
          "20220317-000842--I", "120220317-000842-017-I", "20220317-000842-017-IX",
          "20220317-000842-000-S", "20220317-000842-017-I/file"}) {
        EXPECT_FALSE(parse_chunk_name(name)) << name;
    }
}

}  // namespace
}  // namespace stormcellar::level2
