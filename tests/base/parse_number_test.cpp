#include "base/parse_number.h"

#include <cstdint>

#include <gtest/gtest.h>

namespace stormcellar {
namespace {

TEST(ParseNumber, TakesTheWholeText) {
    EXPECT_EQ(parse_number<int>("-12"), -12);
    EXPECT_EQ(parse_number<std::uint64_t>("18446744073709551615"), UINT64_MAX);
    EXPECT_EQ(parse_number<double>("-0.5"), -0.5);
    for (const char* text : {"", " 1", "1 ", "+1", "1x", "0x1", "1.5"})
        EXPECT_FALSE(parse_number<int>(text)) << text;
    EXPECT_FALSE(parse_number<std::uint8_t>("256")) << "too large";
    EXPECT_FALSE(parse_number<std::uint64_t>("-1")) << "a negative number";
    EXPECT_FALSE(parse_number<double>("1e999"));
}

TEST(ParseIndex, HasOneForm) {
    EXPECT_EQ(parse_index("0"), 0U);
    EXPECT_EQ(parse_index("10"), 10U);
    for (const char* text : {"", "00", "01", "-1", "+1"})
        EXPECT_FALSE(parse_index(text)) << text;
}

}  // namespace
}  // namespace stormcellar
