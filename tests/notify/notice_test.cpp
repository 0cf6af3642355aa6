// Tests the rule on cells whose answer is known.
#include "notify/notice.h"

#include <cmath>
#include <limits>
#include <map>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace stormcellar::notify {
namespace {

using nlohmann::json;
using retrieve::TrackedCell;

const UtcTime grid_time = *parse_utc("2013-05-20T20:04:00Z", UtcTime{});
const retrieve::FreezingLevels levels{4200, 7300};

NotifyRule moore_rule() {
    return {.name = "moore",
            .area = "KTLX",
            .latitude_deg = 35.34,
            .longitude_deg = -97.49,
            .radius_km = 30,
            .thresholds = {.max_dbz = 55},
            .url = "http://a"};
}

grid::GeoPoint place_at(double east_m, double north_m) {
    const NotifyRule rule = moore_rule();
    const grid::SiteFrame frame(rule.latitude_deg, rule.longitude_deg);
    return frame.to_geo(grid::SiteFrame::from_plane(east_m, north_m));
}

// Returns a cell of 60 dBZ at a place, moving straight in the plane about the place of the rule.
TrackedCell moving_cell(double east_m, double north_m, double u_mps, double v_mps) {
    TrackedCell tracked;
    tracked.id = "20130520_193400_35.30N_97.90W";
    tracked.time = grid_time;
    tracked.cell.position = place_at(east_m, north_m);
    tracked.cell.area_km2 = 120;
    tracked.cell.max_dbz = 60.5F;
    tracked.cell.top_m = 12'000;
    tracked.cell.vil_kg_per_m2 = 40;
    tracked.motion = retrieve::TrackMotion{{u_mps, v_mps}, 1.5};
    for (const int minutes : retrieve::forecast_minutes) {
        const double seconds = 60.0 * minutes;
        tracked.forecasts.push_back({minutes, grid_time + std::chrono::minutes{minutes},
                                     place_at(east_m + seconds * u_mps, north_m + seconds * v_mps),
                                     1000 + seconds});
    }
    return tracked;
}

retrieve::TrackedScan scan_of(TrackedCell cell) {
    return {grid_time, "KTLX", {std::move(cell)}};
}

std::vector<Notice> notices(const NotifyRule& rule, const TrackedCell& cell,
                            std::optional<UtcTime> last = std::nullopt) {
    return notices_of(rule, scan_of(cell), levels, [&](const std::string&) { return last; });
}

TEST(Notices, ACellCountsWithinTheRadius) {
    EXPECT_EQ(notices(moore_rule(), moving_cell(29'999, 0, 0, 0)).size(), 1U);
    EXPECT_EQ(notices(moore_rule(), moving_cell(30'001, 0, 0, 0)).size(), 0U);
    EXPECT_EQ(notices(moore_rule(), moving_cell(0, 0, 0, 0)).size(), 1U);
}

TEST(Notices, AllGivenThresholdsMustBeReached) {
    retrieve::StormCell cell = moving_cell(0, 0, 0, 0).cell;
    EXPECT_TRUE(passes({.max_dbz = 60.5}, cell));
    EXPECT_FALSE(passes({.max_dbz = 60.6}, cell));
    EXPECT_TRUE(passes({.vil_kg_per_m2 = 40}, cell));
    EXPECT_FALSE(passes({.vil_kg_per_m2 = 40.1}, cell));
    EXPECT_TRUE(passes({.top_km = 12}, cell));
    EXPECT_FALSE(passes({.top_km = 12.1}, cell));
    EXPECT_FALSE(passes({.mesh_mm = 0}, cell)) << "an unknown MESH reaches nothing";
    cell.mesh_mm = 25.0F;
    EXPECT_TRUE(passes({.mesh_mm = 25}, cell));
    EXPECT_TRUE(passes({60, 40, 25, 12}, cell));
    EXPECT_FALSE(passes({60, 41, 25, 12}, cell));
    cell.max_dbz = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(passes({.max_dbz = 0}, cell));
}

TEST(Notices, OneMessageACellInTheTime) {
    const TrackedCell cell = moving_cell(0, 0, 0, 0);
    const NotifyRule rule = moore_rule();
    EXPECT_EQ(notices(rule, cell, grid_time).size(), 0U) << "the last message was of this grid";
    EXPECT_EQ(notices(rule, cell, grid_time - rule.every + std::chrono::seconds{1}).size(), 0U);
    EXPECT_EQ(notices(rule, cell, grid_time - rule.every).size(), 1U);
    EXPECT_EQ(notices(rule, cell, grid_time + std::chrono::minutes{5}).size(), 0U)
        << "the last message was of a later grid";
}

TEST(Notices, TheLimitIsThatOfEachCell) {
    retrieve::TrackedScan scan = scan_of(moving_cell(0, 0, 0, 0));
    scan.cells.push_back(moving_cell(5'000, 0, 0, 0));
    scan.cells[1].id = "another";
    const std::map<std::string, UtcTime> last = {{"another", grid_time}};
    const auto due = notices_of(moore_rule(), scan, levels, [&](const std::string& cell) {
        const auto found = last.find(cell);
        return found == last.end() ? std::nullopt : std::optional{found->second};
    });
    ASSERT_EQ(due.size(), 1U);
    EXPECT_EQ(due[0].name, (MessageName{grid_time, scan.cells[0].id}));
    EXPECT_TRUE(notices_of(moore_rule(), {grid_time, "KTLX", {}}, levels, {}).empty());
}

TEST(Notices, TheMessageSaysAllWithUnits) {
    NotifyRule rule = moore_rule();
    rule.thresholds.mesh_mm = 20;
    TrackedCell cell = moving_cell(-20'000, 3'000, 10, 0);
    cell.cell.mesh_mm = 31.26F;
    cell.cell.top_is_at_least = true;
    const auto due = notices(rule, cell);
    ASSERT_EQ(due.size(), 1U);
    const json text = json::parse(due[0].text);
    EXPECT_EQ(text["event"], "cell");
    EXPECT_EQ(text["id"], "20130520_200400_000_20130520_193400_35.30N_97.90W");
    EXPECT_EQ(text["rule"], "moore");
    EXPECT_EQ(text["area"], "KTLX");
    EXPECT_EQ(text["time"], "2013-05-20T20:04:00Z");
    EXPECT_EQ(text["place"],
              json::parse(R"({"latitude_deg":35.34,"longitude_deg":-97.49,"radius_km":30.0})"));
    EXPECT_EQ(text["thresholds"], json::parse(R"({"max_dbz":55.0,"mesh_mm":20.0})"));
    EXPECT_EQ(text["cell"]["id"], cell.id);
    EXPECT_EQ(text["cell"]["origin"], "new");
    EXPECT_EQ(text["cell"]["distance_km"], 20.2);
    EXPECT_NEAR(text["cell"]["azimuth_from_place_deg"], 278.5, 0.1);
    EXPECT_EQ(text["cell"]["max_dbz"], 60.5);
    EXPECT_EQ(text["cell"]["mesh_mm"], 31.3);
    EXPECT_EQ(text["cell"]["assumed_freezing_levels_m"], json::parse("[4200.0,7300.0]"));
    EXPECT_EQ(text["cell"]["top_m"], 12'000);
    EXPECT_EQ(text["cell"]["top_is_at_least"], true);
    EXPECT_EQ(text["cell"]["motion"],
              json::parse(R"({"speed_mps":10.0,"from_deg":270.0,"error_mps":1.5})"));
    EXPECT_EQ(text["closest_approach"]["time"], "2013-05-20T20:37:20Z");
    EXPECT_EQ(text["closest_approach"]["minutes"], 33);
    EXPECT_EQ(text["closest_approach"]["distance_km"], 3.0);
    EXPECT_EQ(text["closest_approach"]["error_km"], 3.0);
    EXPECT_EQ(due[0].text.find("http"), std::string::npos) << "no links";
}

TEST(Notices, WhatIsUnknownIsLeftOut) {
    TrackedCell cell = moving_cell(0, 0, 0, 0);
    cell.motion.reset();
    cell.forecasts.clear();
    const auto due = notices(moore_rule(), cell);
    ASSERT_EQ(due.size(), 1U);
    const json text = json::parse(due[0].text);
    EXPECT_FALSE(text.contains("closest_approach"));
    EXPECT_FALSE(text["cell"].contains("motion"));
    EXPECT_FALSE(text["cell"].contains("mesh_mm"));
    EXPECT_FALSE(text["cell"].contains("assumed_freezing_levels_m"));
}

// Compares the rule with the closed form for straight motions at every angle: passing by, coming,
// leaving, and coming closest after the hour.
TEST(ClosestApproach, AgreesWithStraightMotion) {
    constexpr double pi = 3.14159265358979323846;
    for (const double distance_m : {1'000.0, 30'000.0, 100'000.0}) {
        for (int azimuth = 0; azimuth < 360; azimuth += 15) {
            const double x = distance_m * std::sin(azimuth * pi / 180);
            const double y = distance_m * std::cos(azimuth * pi / 180);
            constexpr double u = 17, v = -6;
            const double seconds = std::clamp(-(x * u + y * v) / (u * u + v * v), 0.0, 3600.0);
            const auto closest = closest_approach(moore_rule(), moving_cell(x, y, u, v));
            ASSERT_TRUE(closest);
            EXPECT_NEAR(closest->distance_m, std::hypot(x + u * seconds, y + v * seconds), 1);
            EXPECT_NEAR(seconds_between(grid_time, closest->time), seconds, 0.1);
            EXPECT_NEAR(closest->error_m, 1000 + std::max(900.0, seconds), 0.2);
        }
    }
}

TEST(ClosestApproach, OfACellThatStandsStill) {
    const auto closest = closest_approach(moore_rule(), moving_cell(3'000, 4'000, 0, 0));
    ASSERT_TRUE(closest);
    EXPECT_NEAR(closest->distance_m, 5'000, 1e-6);
    EXPECT_EQ(closest->time, grid_time);
}

}  // namespace
}  // namespace stormcellar::notify
