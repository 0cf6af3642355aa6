#include "base/checksum.h"

#include <string_view>

#include <gtest/gtest.h>

#include "tests/testing/text_bytes.h"

namespace stormcellar {
namespace {

// Every description of CRC-32 contains this check value.
TEST(Checksum, Crc32OfTheStandardCheckString) {
    EXPECT_EQ(crc32(testing::text_bytes("123456789")), 0xCBF43926U);
}

TEST(Checksum, Crc32ContinuesFromAPreviousValue) {
    EXPECT_EQ(crc32(testing::text_bytes("6789"), crc32(testing::text_bytes("12345"))), 0xCBF43926U);
}

// 2026-11-28: every .apng ended in a chunk with a wrong checksum, because an empty span reset the
// value.
TEST(Checksum, NoBytesLeaveTheValueAsItIs) {
    EXPECT_EQ(crc32({}, 0xCBF43926U), 0xCBF43926U);
    EXPECT_EQ(crc32({}), 0U);
    Xxh3Stream stream;
    stream.append(testing::text_bytes("123456789"));
    stream.append({});
    EXPECT_EQ(stream.value(), xxh3_64(testing::text_bytes("123456789")));
}

// This is the value for empty input in the sanity tests of the xxHash specification.
TEST(Checksum, Xxh3OfNothing) {
    EXPECT_EQ(xxh3_64({}), 0x2D06800538D394C2ULL);
}

}  // namespace
}  // namespace stormcellar
