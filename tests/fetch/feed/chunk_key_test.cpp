// Tests that only keys of chunks become paths.
#include "fetch/feed/chunk_key.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

namespace stormcellar::feed {
namespace {

const UtcTime now = *parse_utc("2026-11-28T12:00:00Z", {});

TEST(ChunkKey, IsReadAndWrittenAgain) {
    const std::string text = "KTLX/494/20220317-000842-001-S";
    const auto key = parse_chunk_key(text, now);
    ASSERT_TRUE(key);
    EXPECT_EQ(key->station, "KTLX");
    EXPECT_EQ(key->volume.number, 494);
    EXPECT_EQ(format_utc(key->volume.time), "2022-03-17T00:08:42Z");
    EXPECT_EQ(key->number, 1);
    EXPECT_EQ(key->kind, level2::ChunkKind::start);
    EXPECT_EQ(to_string(*key), text);
    EXPECT_TRUE(parse_chunk_key("TOKC/999/20261128-115959-094-E", now));
    EXPECT_TRUE(parse_chunk_key("KTLX/1/20261129-110000-002-I", now))
        << "the time is within a day of the clock";
}

TEST(ChunkKey, NothingElseIsTaken) {
    for (const char* key : {"",
                            "/",
                            "KTLX",
                            "KTLX/494",
                            "KTLX/494/",
                            "KTLX/0/20220317-000842-001-S",
                            "KTLX/1000/20220317-000842-001-S",
                            "KTLX/007/20220317-000842-001-S",
                            "KTLX/-1/20220317-000842-001-S",
                            "KTLX/+1/20220317-000842-001-S",
                            "KTLX/1 /20220317-000842-001-S",
                            "ktlx/494/20220317-000842-001-S",
                            "../494/20220317-000842-001-S",
                            "KTLX/../20220317-000842-001-S",
                            "KTLX/494/../../etc/20220317-000842-001-S",
                            "KTLX/494/..",
                            "/KTLX/494/x",
                            "KTLX/494/20220317-000842-000-S",
                            "KTLX/494/20220317-000842-1-S",
                            "KTLX/494/20220317-000842-0001-S",
                            "KTLX/494/20220317-000842-001-X",
                            "KTLX/494/20220317-000842-001-S.bz2",
                            "KTLX/494/x-20220317-000842-001-S",
                            "KTLX/494/20220317_000842_001_S",
                            "KTLX/494/20221317-000842-001-S",
                            "KTLX/494/20220317-250842-001-S",
                            "KTLX/494/20220317-000842-001-S/",
                            "KTLX/494/20220317-000842-001-S\n",
                            "KTLX/494//20220317-000842-001-S",
                            "KTLX/494/L2-BZIP2_KTLX_20220317000842_494_1_S_V06_0",
                            "KTLX/494/19700101-000842-001-S"})
        EXPECT_FALSE(parse_chunk_key(key, now)) << key;
}

// Whatever a bucket lists, only plain paths of three parts may be accepted.
TEST(ChunkKey, OfChangedKeysOnlySuchAreTakenThatAreWrittenTheSame) {
    std::mt19937 chance(1);
    const std::string good = "KTLX/494/20220317-000842-001-S";
    const std::string letters = "0123456789-/.SIEKX_ %\\\n";
    int taken = 0;
    for (int i = 0; i < 200'000; ++i) {
        std::string text = good;
        for (int changes = static_cast<int>(chance() % 3); changes >= 0; --changes) {
            const std::size_t at = chance() % text.size();
            const char letter = letters[chance() % letters.size()];
            switch (chance() % 3) {
                case 0:
                    text[at] = letter;
                    break;
                case 1:
                    text.insert(at, 1, letter);
                    break;
                default:
                    text.erase(at, 1);
            }
        }
        const auto key = parse_chunk_key(text, now);
        if (!key) continue;
        ++taken;
        ASSERT_EQ(to_string(*key), text);
        ASSERT_EQ(std::ranges::count(text, '/'), 2) << text;
        ASSERT_EQ(text.find(".."), std::string::npos) << text;
    }
    EXPECT_GT(taken, 1000);
}

TEST(ChunkKey, OneOfTheFutureIsNotTaken) {
    EXPECT_FALSE(parse_chunk_key("KTLX/494/29991231-000842-001-S", now));
    EXPECT_FALSE(parse_chunk_key("KTLX/494/20261129-130000-001-S", now));
}

TEST(ChunkKey, NumbersOfVolumesGoRound) {
    EXPECT_EQ(volume_number_after(998), 999);
    EXPECT_EQ(volume_number_after(999), 1);
    EXPECT_EQ(volume_number_after(1, 998), 999);
    EXPECT_EQ(volume_number_after(500, 998), 499);
}

}  // namespace
}  // namespace stormcellar::feed
