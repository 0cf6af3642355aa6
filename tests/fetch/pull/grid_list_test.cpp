#include "fetch/pull/grid_list.h"

#include <random>

#include <gtest/gtest.h>

namespace stormcellar::pull {
namespace {

const UtcTime now = *parse_utc("2026-11-27T12:00:00Z", UtcTime{});
const PullSource north{"north", "http://n:1/p", {"us"}};

Result<std::vector<cache::GridName>> parsed(std::string_view text,
                                            const PullSource& source = north) {
    return parse_grid_list(std::as_bytes(std::span(text)), source, now - std::chrono::hours{1},
                           now);
}

std::string entry(const std::string& domain, const std::string& moment, const std::string& time) {
    return R"({"domain":")" + domain + R"(","moment":")" + moment + R"(","time":")" + time +
           R"(","path":"/x"})";
}

TEST(GridList, HasThePartsOfTheDomainsNewestFirst) {
    const auto grids =
        parsed(R"({"grids":[)" + entry("us.KTLX", "REF", "2026-11-27T11:50:00Z") + "," +
               entry("us.KINX", "VEL", "2026-11-27T11:55:00.250Z") + "," +
               entry("us.KTLX", "REF", "2026-11-27T11:50:00Z") + "," +
               entry("us", "REF", "2026-11-27T11:50:00Z") + "," +
               entry("KTLX", "REF", "2026-11-27T11:50:00Z") + "," +
               entry("eu.KTLX", "REF", "2026-11-27T11:50:00Z") + R"(],"more":false})");
    ASSERT_TRUE(grids) << grids.error().message;
    ASSERT_EQ(grids->size(), 2U);
    EXPECT_EQ(grids->at(0).domain, "us.KINX");
    EXPECT_EQ(grids->at(1).domain, "us.KTLX");
    EXPECT_EQ(file_url(north, grids->at(0)),
              "http://n:1/p/api/v1/grids/us.KINX/VEL/2026-11-27T11:55:00.250Z/file");
    EXPECT_EQ(parsed(R"({"grids":[)" + entry("eu.KTLX", "REF", "2026-11-27T11:50:00Z") + "]}",
                     {"north", "http://n", {}})
                  ->size(),
              1U)
        << "without a list of domains, all domains count";
}

// 2026-11-28: a list of four megabytes has 67,000 names, and the puller kept all these names.
TEST(GridList, HasTheNewestOfMoreThanAnyMachineHas) {
    std::string entries;
    for (std::size_t i = 0; i <= most_listed; ++i) {
        const UtcTime time = now - std::chrono::milliseconds{100 * (most_listed - i)};
        entries += (i == 0 ? "" : ",") + entry("us.KTLX", "REF", format_utc(time));
    }
    const auto grids = parsed("{\"grids\":[" + entries + "]}");
    ASSERT_TRUE(grids) << grids.error().message;
    ASSERT_EQ(grids->size(), most_listed);
    EXPECT_EQ(grids->front().time, now);
}

TEST(GridList, LeavesOutWhatMakesNoSense) {
    for (const std::string& one :
         {entry("../../etc.KTLX", "REF", "2026-11-27T11:50:00Z"),
          entry("us.KTLX", "XYZ", "2026-11-27T11:50:00Z"), entry("us.KTLX", "REF", "now"),
          entry("us.KTLX", "REF", "-1h"), entry("us.KTLX", "REF", "2026-11-27T10:59:59Z"),
          entry("us.KTLX", "REF", "2026-11-28T00:00:00Z"), std::string("7"), std::string("{}"),
          std::string(R"({"domain":7,"moment":[],"time":{}})")}) {
        const auto grids = parsed("{\"grids\":[" + one + "]}");
        ASSERT_TRUE(grids) << one;
        EXPECT_TRUE(grids->empty()) << one;
    }
}

// Only names of partials of these domains may be accepted, and no path may lead elsewhere, whatever
// a machine sends.
TEST(GridList, OfMutantsOnlyPossibleNamesAreLeft) {
    const std::string good = R"({"grids":[)" + entry("us.KTLX", "REF", "2026-11-27T11:50:00Z") +
                             "," + entry("us.KINX", "VEL", "2026-11-27T11:55:00.250Z") +
                             R"(],"more":false})";
    std::mt19937 random(20261127);
    std::size_t lists = 0;
    for (int i = 0; i < 5'000; ++i) {
        std::string text = good;
        for (std::uint32_t changes = 1 + random() % 4; changes > 0; --changes) {
            const std::size_t at = random() % text.size();
            const std::size_t count = 1 + random() % 12;
            switch (random() % 4) {
                case 0:
                    text[at] = static_cast<char>(random());
                    break;
                case 1:
                    text.erase(at, count);
                    break;
                case 2:
                    text.insert(at, text.substr(random() % text.size(), count));
                    break;
                default:
                    text[at] = "./\\\"{}[]:,-0Z"[random() % 14];
            }
            if (text.empty()) text = good;
        }
        const auto grids = parsed(text);
        if (!grids) continue;
        ++lists;
        for (const cache::GridName& name : *grids) {
            ASSERT_TRUE(name.domain.starts_with("us.")) << text;
            ASSERT_TRUE(cache::is_domain_name(name.domain) && cache::is_part(name.domain)) << text;
            ASSERT_TRUE(name.time >= now - std::chrono::hours{1} && is_believed(name.time, now));
        }
    }
    EXPECT_GT(lists, 300U);
    EXPECT_FALSE(parsed(std::string(most_list_bytes, '[')))
        << "lists that are nested deeply are refused";
}

TEST(GridList, WhatIsNoListIsCorrupt) {
    for (const char* text : {"", "<html>", "[]", "{}", R"({"grids":7})", R"({"grids":[)", "null"})
        EXPECT_EQ(parsed(text).error().code, ErrorCode::corrupt) << text;
}

}  // namespace
}  // namespace stormcellar::pull
