#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/web/asked.h"
#include "web/doors/thredds/query.h"

namespace stormcellar::web {
namespace {

using ::testing::HasSubstr;

const UtcTime query_now = *parse_compact("20260328_201500");

Result<ThreddsQuery> query_of(std::string_view text) {
    return read_thredds_query(
        request_for("/thredds/radarServer/nexrad/level2/IDD?" + std::string{text}), query_now);
}

std::string refusal_of(std::string_view text) {
    const auto query = query_of(text);
    return query ? "none" : query.error().message;
}

TEST(ThreddsQuery, StationsMayBeRepeatedOrListed) {
    const auto query = query_of("stn=KTLX&stn=KFTG,KLOT&stn=KTLX&time=2015-06-15T12%3A00%3A00");
    ASSERT_TRUE(query) << query.error().message;
    EXPECT_EQ(query->stations, (std::vector<std::string>{"KTLX", "KFTG", "KLOT"}));
    ASSERT_EQ(query->times.size(), 1U);
    EXPECT_EQ(format_utc(query->times[0]), "2015-06-15T12:00:00Z");
    EXPECT_FALSE(query->from || query->to || query->near || query->box || query->all_stations);
}

// 2026-11-28: var=N0Q/0,N0Q/1,... counted as a hundred variables, and each of them was searched.
TEST(ThreddsQuery, AVariableCountsOnceWhateverIsBehindItsSlash) {
    const auto query = query_of("stn=FTG&temporal=all&var=N0Q/0,N0Q/1,N0C&var=N0Q");
    ASSERT_TRUE(query) << query.error().message;
    EXPECT_EQ(query->variables, (std::vector<std::string>{"N0Q", "N0C"}));
}

TEST(ThreddsQuery, TwoOfStartEndAndDurationMakeARange) {
    for (const char* text : {"time_start=2015-06-15T12:00:00Z&time_end=2015-06-16T12:00:00Z",
                             "time_start=2015-06-15T12:00:00Z&time_duration=P1D",
                             "time_duration=24%20hours&time_end=2015-06-16T12:00:00Z"}) {
        const auto query = query_of("stn=KTLX&" + std::string{text});
        ASSERT_TRUE(query) << query.error().message;
        EXPECT_EQ(format_utc(*query->from), "2015-06-15T12:00:00Z") << text;
        EXPECT_EQ(format_utc(*query->to), "2015-06-16T12:00:00Z") << text;
        EXPECT_TRUE(query->times.empty());
    }
    const auto present = query_of("&stn=KTLX&time_start=2026-03-28&time_end=present");
    ASSERT_TRUE(present);
    EXPECT_EQ(present->to, query_now);
    const auto all = query_of("stn=KTLX&temporal=all");
    ASSERT_TRUE(all);
    EXPECT_FALSE(all->from || all->to);
    EXPECT_TRUE(all->times.empty());
}

TEST(ThreddsQuery, PlacesAreAPointOrABox) {
    const auto point = query_of("longitude=-97.3&latitude=35.3&temporal=all");
    ASSERT_TRUE(point && point->near);
    EXPECT_EQ(point->near->latitude_deg, 35.3);
    EXPECT_EQ(point->near->longitude_deg, -97.3);
    const auto box = query_of("north=40&south=35&east=-90&west=-100&temporal=all");
    ASSERT_TRUE(box && box->box);
    EXPECT_TRUE(is_inside(*box->box, 37, -95));
    EXPECT_FALSE(is_inside(*box->box, 37, -89));
    EXPECT_FALSE(is_inside(*box->box, 41, -95));
    const ThreddsQuery::Box across{30, 10, -170, 140};
    EXPECT_TRUE(is_inside(across, 13.5, 144.8)) << "Guam";
    EXPECT_TRUE(is_inside(across, 20, -175));
    EXPECT_FALSE(is_inside(across, 21.1, -157.2)) << "Hawaii is east of the box";
    EXPECT_TRUE(is_inside({90, -90, 360, 0}, 0, -97));
    EXPECT_TRUE(is_inside({50, 20, 295, 230}, 35, -97)) << "degrees to the east from 0 to 360";
}

TEST(ThreddsQuery, WhatIsMissingOrWrongIsASentence) {
    struct Case {
        const char *query, *part;
    };
    for (const Case& one :
         {Case{"time=present", "stations are required"}, Case{"stn=KTLX", "time is required"},
          Case{"stn=KTLX&time_start=2015-01-01", "two of"},
          Case{"stn=KTLX&time=yesterday", "\"yesterday\" is not a time"},
          Case{"stn=KTLX&time_start=2015-01-01&time_duration=long", "duration"},
          Case{"longitude=5&temporal=all", "latitude, longitude"},
          Case{"longitude=5&latitude=95&temporal=all", "from -90 to 90"},
          Case{"longitude=nan&latitude=5&temporal=all", "longitude"},
          Case{"north=1&south=2&east=3&west=4&temporal=all", "less than south"},
          Case{"stn=KTLX&time_start=2016-01-01&time_end=2015-01-01", "after time_end"}})
        EXPECT_THAT(refusal_of(one.query), HasSubstr(one.part)) << one.query;
}

TEST(ThreddsQuery, StationsAndTimesAreBounded) {
    std::string stations, times;
    for (int i = 0; i < 401; ++i)
        stations += fmt::format("{}K{:03}", i ? "," : "stn=", i);
    EXPECT_THAT(refusal_of(stations + "&time=present"), HasSubstr("at most 400 stations"));
    for (int i = 0; i < 101; ++i)
        times += fmt::format("&time=2015-06-15T12:{:02}:{:02}", i / 60, i % 60);
    EXPECT_THAT(refusal_of("stn=KTLX" + times), HasSubstr("at most 100 times"));
}

TEST(ThreddsQuery, VariablesLoseWhatTheirNamesExplain) {
    const auto query = query_of("stn=FTG&var=N0Q%2FBase%20Reflectivity&var=N0C&temporal=all");
    ASSERT_TRUE(query);
    EXPECT_EQ(query->variables, (std::vector<std::string>{"N0Q", "N0C"}));
}

}  // namespace
}  // namespace stormcellar::web
