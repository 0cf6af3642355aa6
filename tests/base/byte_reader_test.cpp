#include "base/byte_reader.h"

#include <array>

#include <gtest/gtest.h>

namespace stormcellar {
namespace {

constexpr std::array<std::byte, 7> bytes = {std::byte{0xFF}, std::byte{0xFE}, std::byte{0x01},
                                            std::byte{0x02}, std::byte{0x03}, std::byte{0x41},
                                            std::byte{0x42}};

TEST(ByteReader, ReadsBigEndianNumbersInOrder) {
    ByteReader reader(bytes);
    EXPECT_EQ(reader.i16(), -2);
    EXPECT_EQ(reader.u8(), 1);
    EXPECT_EQ(reader.u16(), 0x0203);
    EXPECT_EQ(reader.text(2), "AB");
    EXPECT_EQ(reader.remaining(), 0U);
    EXPECT_FALSE(reader.failed());
}

TEST(ByteReader, ReadPastTheEndFailsAndStaysFailed) {
    ByteReader reader{std::span<const std::byte>(bytes).first(3)};
    EXPECT_EQ(reader.u32(), 0U);
    EXPECT_TRUE(reader.failed());
    EXPECT_EQ(reader.u8(), 0U) << "after a failure, every read returns 0";
    EXPECT_EQ(reader.position(), 0U);
}

TEST(ByteReader, SeekBeyondTheEndFails) {
    ByteReader reader(bytes);
    reader.seek(7);
    EXPECT_FALSE(reader.failed());
    reader.seek(8);
    EXPECT_TRUE(reader.failed());
}

TEST(ByteReader, SkipOfAHugeCountDoesNotWrapRound) {
    ByteReader reader(bytes);
    reader.skip(2);
    reader.skip(static_cast<std::size_t>(-1));
    EXPECT_TRUE(reader.failed());
    EXPECT_EQ(reader.position(), 2U);
}

}  // namespace
}  // namespace stormcellar
