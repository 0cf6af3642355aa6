#include "base/local_time.h"

#include <cstdlib>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace stormcellar {
namespace {

std::string local(const char* utc, const char* zone) {
    return format_local(parse_compact(utc).value(), zone).value();
}

// In the United States, daylight saving time ran from the first Sunday of April to the last Sunday
// of October until 2006. Since 2007 it runs from the second Sunday of March to the first Sunday of
// November.
TEST(LocalTime, FollowsTheRulesOfItsDay) {
    EXPECT_EQ(local("19990503_235621", "America/Chicago"), "1999-05-03 18:56:21 CDT");
    EXPECT_EQ(local("20080109_141449", "America/New_York"), "2008-01-09 09:14:49 EST");
    EXPECT_EQ(local("20060320_120000", "America/Denver"), "2006-03-20 05:00:00 MST");
    EXPECT_EQ(local("20070320_120000", "America/Denver"), "2007-03-20 06:00:00 MDT");
    EXPECT_EQ(local("20200701_000000", "America/Phoenix"), "2020-06-30 17:00:00 MST");
    EXPECT_EQ(local("20200701_000000", "Pacific/Guam"), "2020-07-01 10:00:00 ChST");
    EXPECT_EQ(local("20240229_230000", "Asia/Seoul"), "2024-03-01 08:00:00 KST");
    EXPECT_EQ(local("20240101_000000", "UTC"), "2024-01-01 00:00:00 UTC");
    EXPECT_EQ(local("20240101_000000", "America/Sao_Paulo"), "2023-12-31 21:00:00 -03");
}

TEST(LocalTime, TheHourThatComesTwice) {
    EXPECT_EQ(local("20231105_065959", "America/Chicago"), "2023-11-05 01:59:59 CDT");
    EXPECT_EQ(local("20231105_070000", "America/Chicago"), "2023-11-05 01:00:00 CST");
}

TEST(LocalTime, FractionsGoDownAlsoBefore1970) {
    const auto text = [](int milliseconds) {
        return format_local(UtcTime{std::chrono::milliseconds(milliseconds)}, "UTC").value();
    };
    EXPECT_EQ(text(999), "1970-01-01 00:00:00 UTC");
    EXPECT_EQ(text(-1), "1969-12-31 23:59:59 UTC");
}

TEST(LocalTime, WhatIsNoZoneIsRefused) {
    for (const char* zone : {"", "Atlantis/Capital", "../../etc/passwd", "America"}) {
        const auto text = format_local(UtcTime{}, zone);
        ASSERT_FALSE(text) << zone;
        EXPECT_EQ(text.error().code, ErrorCode::bad_argument);
    }
}

TEST(LocalTime, FromManyThreads) {
    std::vector<std::thread> threads;
    std::vector<std::string> texts(8);
    for (std::size_t i = 0; i < texts.size(); ++i) {
        threads.emplace_back([&texts, i] {
            for (int n = 0; n < 50; ++n)
                texts[i] = local("19990503_235621", n % 2 != 0 ? "America/Chicago" : "Asia/Tokyo");
        });
    }
    for (auto& thread : threads)
        thread.join();
    for (const std::string& text : texts)
        EXPECT_EQ(text, "1999-05-03 18:56:21 CDT");
}

TEST(LocalTime, TheMachinesZoneIsAZone) {
    const std::string zone = machine_time_zone();
    if (!zone.empty()) {
        EXPECT_TRUE(format_local(UtcTime{}, zone)) << zone;
    }
    ASSERT_EQ(setenv("TZ", ":Pacific/Honolulu", 1), 0);
    EXPECT_EQ(machine_time_zone(), "Pacific/Honolulu");
    ASSERT_EQ(setenv("TZ", "EST5EDT4,M3.2.0,M11.1.0", 1), 0);
    EXPECT_EQ(machine_time_zone(), "") << "a POSIX rule is not the name of a zone";
    ASSERT_EQ(unsetenv("TZ"), 0);
}

}  // namespace
}  // namespace stormcellar
