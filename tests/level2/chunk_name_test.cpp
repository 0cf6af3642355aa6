#include "stormcellar/level2/chunk_name.h"

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

TEST(ChunkName, AKeyOfLdmIsReadWithAnySeparator) {
    for (const char* name :
         {"L2-BZIP2_KFTG_20150908215946_494_43_I_V06_0",
          "L2-BZIP2-KFTG-20150908215946-494-43-I-V06-0",
          "L2-BZIP2.KFTG.20150908215946.494.43.I.V06.0", "/ldm/KFTG/20150908215946_494_43_I"}) {
        const auto placed = place_chunk_name(name);
        ASSERT_TRUE(placed) << name;
        EXPECT_TRUE(placed->name.volume.starts_with("20150908215946")) << placed->name.volume;
        EXPECT_TRUE(placed->name.volume.ends_with("494")) << placed->name.volume;
        EXPECT_EQ(placed->name.number, 43);
        EXPECT_EQ(placed->name.kind, ChunkKind::intermediate);
        EXPECT_EQ(std::string_view{name}.substr(placed->number_at, 2), "43");
        EXPECT_EQ(name[placed->behind - 1], 'I');
    }
    EXPECT_EQ(parse_chunk_name("KFTG_20150908215946_494_1_S")->volume, "20150908215946_494");
}

TEST(ChunkName, OtherNamesAreNone) {
    for (const char* name :
         {"", "KLOT20220317_000842_V06", "20220317-000842-017-X", "20220317-000842-0017-I",
          "20220317-000842--I", "120220317-000842-017-I", "20220317-000842-017-IX",
          "20220317-000842-000-S", "20220317-000842-017-I/file", "KFTG_20150908215946_43_I",
          "KFTG_20150908215946_494_I", "KFTG_20150908215946_1494_43_I",
          "KFTG20150908_215946_V06"}) {
        EXPECT_FALSE(parse_chunk_name(name)) << name;
    }
}

}  // namespace
}  // namespace stormcellar::level2
