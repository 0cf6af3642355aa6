#include "base/byte_size.h"

#include <gtest/gtest.h>

namespace stormcellar {
namespace {

TEST(ByteSize, ReadsNumbersWithAndWithoutUnits) {
    EXPECT_EQ(*parse_byte_size("0"), 0U);
    EXPECT_EQ(*parse_byte_size("123456"), 123'456U);
    EXPECT_EQ(*parse_byte_size("20 GB"), 20'000'000'000U);
    EXPECT_EQ(*parse_byte_size("20gb"), 20'000'000'000U);
    EXPECT_EQ(*parse_byte_size("1.5 KiB"), 1536U);
    EXPECT_EQ(*parse_byte_size("2 MiB"), 2'097'152U);
    EXPECT_EQ(*parse_byte_size("1 TB"), 1'000'000'000'000U);
    EXPECT_EQ(*parse_byte_size("7B"), 7U);
    EXPECT_EQ(*parse_byte_size("0.5"), 0U);
}

TEST(ByteSize, RefusesWhatIsNoAmount) {
    for (const char* text : {"", " ", "GB", "-1", "1 XB", "1 GB 2", "20 G", "nan", "inf", "1e3",
                             " 1", "9223372036854775808", "10000000000 TB", "0x10"}) {
        const auto parsed = parse_byte_size(text);
        ASSERT_FALSE(parsed) << text;
        EXPECT_EQ(parsed.error().code, ErrorCode::bad_argument);
    }
}

TEST(ByteSize, IsWrittenWithThreeDigits) {
    EXPECT_EQ(format_byte_size(0), "0 B");
    EXPECT_EQ(format_byte_size(999), "999 B");
    EXPECT_EQ(format_byte_size(1000), "1.00 kB");
    EXPECT_EQ(format_byte_size(12'345'678), "12.3 MB");
    EXPECT_EQ(format_byte_size(999'999), "1.00 MB");
    EXPECT_EQ(format_byte_size(20'000'000'000), "20.0 GB");
    EXPECT_EQ(format_byte_size(5'000'000'000'000'000), "5000 TB");
}

}  // namespace
}  // namespace stormcellar
