#include "stormcellar/base/utc_time.h"

#include <gtest/gtest.h>

namespace stormcellar {
namespace {

const UtcTime noon = *parse_utc("2022-03-17T12:00:00Z", UtcTime{});

TEST(UtcTime, NexradDayOneIsTheEpoch) {
    EXPECT_EQ(format_utc(time_from_nexrad(1, 0)), "1970-01-01T00:00:00Z");
    // An independent decoder reads this time from the header of KTLX19990503_235621.
    EXPECT_EQ(format_utc(time_from_nexrad(10715, 86181000)), "1999-05-03T23:56:21Z");
}

TEST(UtcTime, MillisecondsBeyondMidnightAreCarried) {
    EXPECT_EQ(format_utc(time_from_nexrad(10715, 86400500)), "1999-05-04T00:00:00.500Z");
}

TEST(UtcTime, NexradRoundTrip) {
    const NexradTime parts = nexrad_from_time(time_from_nexrad(19069, 522596));
    EXPECT_EQ(parts.day, 19069U);
    EXPECT_EQ(parts.milliseconds, 522596U);
}

TEST(UtcTime, ParsesEveryFormThatItPromises) {
    EXPECT_EQ(format_utc(*parse_utc("2022-03-17", noon)), "2022-03-17T00:00:00Z");
    EXPECT_EQ(format_utc(*parse_utc("2022-03-17T00:08", noon)), "2022-03-17T00:08:00Z");
    EXPECT_EQ(format_utc(*parse_utc("2022-03-17 00:08:42", noon)), "2022-03-17T00:08:42Z");
    EXPECT_EQ(format_utc(*parse_utc("2022-03-17T00:08:42.596Z", noon)), "2022-03-17T00:08:42.596Z");
    EXPECT_EQ(format_utc(*parse_utc("20220317_000842", noon)), "2022-03-17T00:08:42Z");
    EXPECT_EQ(*parse_utc("now", noon), noon);
    EXPECT_EQ(format_utc(*parse_utc("-90m", noon)), "2022-03-17T10:30:00Z");
    EXPECT_EQ(format_utc(*parse_utc("-2d", noon)), "2022-03-15T12:00:00Z");
}

class NotATime : public ::testing::TestWithParam<const char*> {};
TEST_P(NotATime, IsRefusedWithTheTextInTheMessage) {
    const auto time = parse_utc(GetParam(), noon);
    ASSERT_FALSE(time);
    EXPECT_EQ(time.error().code, ErrorCode::bad_argument);
    EXPECT_NE(time.error().message.find(GetParam()), std::string::npos);
}
INSTANTIATE_TEST_SUITE_P(UtcTime, NotATime,
                         ::testing::Values("yesterday", "2022-13-01", "2022-02-30",
                                           "2022-03-17T24:00", "-1", "-h", "-1y",
                                           "-99999999999999h", "20220317000842",
                                           "2022-03-17T00:08:42.", "2022-03-17T00:08:4", "+1h"));

TEST(UtcTime, LeapDay) {
    EXPECT_EQ(format_compact(*parse_utc("2024-02-29", noon)), "20240229_000000");
    EXPECT_FALSE(parse_utc("2023-02-29", noon));
}

}  // namespace
}  // namespace stormcellar
