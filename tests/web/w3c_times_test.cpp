#include "web/doors/thredds/w3c_times.h"

#include <gtest/gtest.h>

namespace stormcellar::web {
namespace {

using namespace std::chrono_literals;

const UtcTime w3c_now = *parse_compact("20260328_201500");

std::string w3c_text(std::string_view text) {
    const auto time = parse_w3c_time(text, w3c_now);
    return time ? format_utc(*time) : "none";
}

TEST(W3cTimes, TakesEveryPrecisionAndOffset) {
    struct Case {
        const char *text, *time;
    };
    for (const Case& one : {Case{"2015", "2015-01-01T00:00:00Z"},
                            {"2015-06", "2015-06-01T00:00:00Z"},
                            {"2015-06-15", "2015-06-15T00:00:00Z"},
                            {"2015-06-15Z", "2015-06-15T00:00:00Z"},
                            {"2015-06-15T12", "2015-06-15T12:00:00Z"},
                            {"2015-06-15T12:30", "2015-06-15T12:30:00Z"},
                            {"2015-06-15T12:30:15", "2015-06-15T12:30:15Z"},
                            {"2015-06-15T12:30:15.25Z", "2015-06-15T12:30:15.250Z"},
                            {"2015-06-15T12:30:15.123456", "2015-06-15T12:30:15.123Z"},
                            {"2015-06-15 12:30:15", "2015-06-15T12:30:15Z"},
                            {"2015-06-15T24:00", "2015-06-16T00:00:00Z"},
                            {"present", "2026-03-28T20:15:00Z"},
                            {"2015-06-15T12:00+01:00", "2015-06-15T11:00:00Z"},
                            // An unencoded plus in a query becomes a space.
                            {"2015-06-15T12:00 01:00", "2015-06-15T11:00:00Z"},
                            {"2015-06-15T12:00:00-0530", "2015-06-15T17:30:00Z"}})
        EXPECT_EQ(w3c_text(one.text), one.time) << one.text;
}

TEST(W3cTimes, AnythingElseIsRefused) {
    for (const char* text :
         {"", "now", "15-06-2015", "2015-13", "2015-02-30", "2015-06-15T", "2015-06-15T25:00",
          "2015-06-15T12:60", "2015-06-15T12:00:61", "2015-06-15T12:00:00.",
          "2015-06-15T12:00+99:00", "2015-06-15T12:00Zx", "0015-06-15", "99999-01-01", "2015-6-15",
          "-1h", "2015-06-15T24:00:01"})
        EXPECT_EQ(w3c_text(text), "none") << text;
    const auto error = parse_w3c_time(std::string(5000, '9'), w3c_now);
    ASSERT_FALSE(error);
    EXPECT_LT(error.error().message.size(), 200U);
}

TEST(W3cTimes, DurationsAreThoseOfSchemaOrWords) {
    const auto rest = [](std::string_view text) { return parse_w3c_duration(text).value().rest; };
    EXPECT_EQ(rest("PT1H"), 1h);
    EXPECT_EQ(rest("P1DT12H30M1.5S"), 36h + 30min + 1500ms);
    EXPECT_EQ(rest("P2W"), 24h * 14);
    EXPECT_EQ(rest("14 days"), 24h * 14);
    EXPECT_EQ(rest("1 day"), 24h);
    EXPECT_EQ(rest("90 mins"), 90min);
    EXPECT_EQ(rest("2hours"), 2h);
    EXPECT_EQ(rest("0.5 hours"), 30min);
    EXPECT_EQ(parse_w3c_duration("P1Y2M3D").value(), (W3cDuration{14, 72h}));
    EXPECT_EQ(parse_w3c_duration("3 months").value(), (W3cDuration{3, 0ms}));
    for (const char* text : {"", "P", "PT", "P1", "P1H", "PT1D", "-P1D", "P1DT", "1", "days",
                             "1 fortnight", "P9999999D", "P1.5M", "99999999999 years", "P1D "})
        EXPECT_FALSE(parse_w3c_duration(text)) << text;
}

TEST(W3cTimes, AMonthBeforeTheLastOfMarchIsTheLastOfFebruary) {
    const UtcTime end = *parse_compact("20240331_120000");
    EXPECT_EQ(format_compact(earlier_by(end, {1, 0ms})), "20240229_120000");
    EXPECT_EQ(format_compact(later_by(end, {11, 1h})), "20250228_130000");
    EXPECT_EQ(format_compact(earlier_by(end, {12, 1h})), "20230331_110000");
}

}  // namespace
}  // namespace stormcellar::web
