// Tests tracks of storm cells: with simulated storms whose motion is known, and with scans that are
// missing, out of order or repeated.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/retrieve/cells_scene.h"

namespace stormcellar::retrieve {
namespace {

constexpr UtcTime first_time{std::chrono::hours(24 * 365 * 54)};

// A scan of round cells at these places, in km east and north of 35 N 97 W.
struct CellPlace {
    double x_km, y_km;
};
CellScan drawn_scan(double minutes, const std::vector<CellPlace>& places) {
    CellScan scan;
    scan.time = first_time + std::chrono::seconds(static_cast<long>(60 * minutes));
    scan.area = "KTLX";
    scan.spec = grid::default_spec(35, -97);
    const grid::GridProjection projection(scan.spec);
    for (const CellPlace& place : places) {
        StormCell cell;
        cell.max_dbz = 50;
        const double x = place.x_km + scan.spec.center_x(), y = place.y_km + scan.spec.center_y();
        cell.position = projection.to_geo({x, y});
        const auto ix = static_cast<int>(std::lround(x)), iy = static_cast<int>(std::lround(y));
        for (int row = -4; row <= 4; ++row)
            cell.columns.push_back({iy + row, ix - 4, ix + 5});
        scan.cells.push_back(cell);
    }
    return scan;
}

std::vector<TrackedScan> tracked(const std::vector<CellScan>& scans) {
    auto result = track_cells(scans);
    EXPECT_TRUE(result) << result.error().message;
    return result ? std::move(*result) : std::vector<TrackedScan>{};
}

TEST(TrackCells, KnowTheMotionOfSixStormsAfterThreeVolumes) {
    const std::vector<SceneStorm> storms = {{-70, 20, 15, 8}, {-30, 70, 14, 6},  {20, -60, 17, 9},
                                            {40, 30, 12, 10}, {70, -20, 15, 12}, {-60, -60, 18, 4}};
    const synth::Scene scene = cells_scene(storms);
    const auto scans = tracked(scene_scans(scene, 3));
    ASSERT_EQ(scans.size(), 3U);
    ASSERT_EQ(scans.back().cells.size(), storms.size());
    for (const TrackedCell& cell : scans.back().cells) {
        const SceneStorm* storm = nullptr;
        for (const SceneStorm& other : storms) {
            if (between_m(cell.cell.position, storm_place(scene, other, 2)) < 2000) storm = &other;
        }
        ASSERT_NE(storm, nullptr);
        EXPECT_EQ(cell.origin, CellOrigin::continued);
        EXPECT_EQ(cell.past.size(), 2U);
        ASSERT_TRUE(cell.motion);
        const Motion truth{storm->east_mps, storm->north_mps};
        const Motion found = cell.motion->velocity;
        EXPECT_LT(std::hypot(found.u_mps - truth.u_mps, found.v_mps - truth.v_mps), 2);
        EXPECT_LT(std::abs(std::remainder(found.direction_deg() - truth.direction_deg(), 360)), 10);
        ASSERT_EQ(cell.forecasts.size(), forecast_minutes.size());
        // The forecast for 15 minutes is the place at volume 5, within two of its errors.
        EXPECT_LT(between_m(cell.forecasts[0].position, storm_place(scene, *storm, 5)),
                  2 * cell.forecasts[0].error_m);
        EXPECT_LT(cell.forecasts[0].error_m, cell.forecasts[3].error_m);
    }
}

TEST(TrackCells, NamesASplit) {
    // Two storms drift apart, from 3 to 15 km.
    const auto scans =
        tracked(scene_scans(cells_scene({{-20, 50, 10, 15, 10}, {-20, 47, 10, 5, 10, 53}}), 5));
    std::size_t splits = 0;
    for (std::size_t i = 1; i < scans.size(); ++i) {
        for (const TrackedCell& cell : scans[i].cells) {
            if (cell.origin != CellOrigin::split) continue;
            ++splits;
            ASSERT_EQ(cell.parents.size(), 1U);
            EXPECT_EQ(cell.parents[0], scans[0].cells.at(0).id);
            EXPECT_TRUE(cell.motion);  // of its parent
        }
    }
    EXPECT_EQ(splits, 1U);
    EXPECT_EQ(scans.front().cells.size(), 1U);
    EXPECT_EQ(scans.back().cells.size(), 2U);
}

TEST(TrackCells, NamesAMerger) {
    const auto scans =
        tracked(scene_scans(cells_scene({{-20, 50, 10, 5, 10}, {-20, 35, 10, 15, 10, 53}}), 5));
    ASSERT_EQ(scans.front().cells.size(), 2U);
    std::size_t mergers = 0;
    for (std::size_t i = 1; i < scans.size(); ++i) {
        for (const TrackedCell& cell : scans[i].cells) {
            if (cell.origin != CellOrigin::merged) continue;
            ++mergers;
            EXPECT_EQ(scans[i].cells.size(), 1U);
            ASSERT_EQ(cell.parents.size(), 1U);
            EXPECT_NE(cell.parents[0], cell.id);
            EXPECT_TRUE(cell.parents[0] == scans[0].cells[0].id ||
                        cell.parents[0] == scans[0].cells[1].id);
        }
    }
    EXPECT_EQ(mergers, 1U);
    EXPECT_EQ(scans.back().cells.size(), 1U);
}

TEST(TrackCells, SurviveAMissingScan) {
    const auto scans =
        tracked({drawn_scan(0, {{0, 0}}), drawn_scan(5, {{6, 0}}), drawn_scan(15, {{18, 0}}),
                 drawn_scan(20, {}), drawn_scan(25, {{30, 0}})});
    ASSERT_EQ(scans.size(), 5U);
    const TrackedCell& cell = scans.back().cells.at(0);
    EXPECT_EQ(cell.id, scans[0].cells.at(0).id);
    EXPECT_EQ(cell.origin, CellOrigin::continued);
    EXPECT_EQ(cell.past.size(), 3U);
    ASSERT_TRUE(cell.motion);
    EXPECT_NEAR(cell.motion->velocity.u_mps, 20, 0.5);
    EXPECT_NEAR(cell.motion->velocity.v_mps, 0, 0.5);
}

TEST(TrackCells, EndAfterALongGap) {
    const auto scans = tracked({drawn_scan(0, {{0, 0}}), drawn_scan(30, {{0, 0}})});
    EXPECT_EQ(scans[1].cells.at(0).origin, CellOrigin::first);
    EXPECT_NE(scans[1].cells.at(0).id, scans[0].cells.at(0).id);
}

TEST(TrackCells, SortScansByTimeAndTakeTheLastOfEachTime) {
    const std::vector<CellScan> in_order = {drawn_scan(0, {{0, 0}}), drawn_scan(5, {{6, 0}}),
                                            drawn_scan(10, {{12, 0}})};
    const auto expected = tracked(in_order);
    const auto scans =
        tracked({in_order[2], in_order[0], drawn_scan(5, {{100, 100}, {50, 50}}), in_order[1]});
    ASSERT_EQ(scans.size(), 3U);
    EXPECT_EQ(scans[0].time, in_order[0].time);
    EXPECT_EQ(scans[1].cells.size(), 1U);
    EXPECT_EQ(scans[2].cells.at(0).id, expected[2].cells.at(0).id);
    EXPECT_EQ(scans[2].cells.at(0).past.size(), 2U);
}

TEST(TrackCells, IdsStayTheSameIfLaterScansAreAdded) {
    std::vector<CellScan> scans = {drawn_scan(0, {{0, 0}, {40, 40}}),
                                   drawn_scan(5, {{43, 42}, {3, 2}, {-50, 0}})};
    const auto before = tracked(scans);
    scans.push_back(drawn_scan(10, {{6, 4}, {-47, 2}}));
    const auto after = tracked(scans);
    ASSERT_EQ(before[1].cells.size(), after[1].cells.size());
    for (std::size_t i = 0; i < before[1].cells.size(); ++i)
        EXPECT_EQ(before[1].cells[i].id, after[1].cells[i].id);
    EXPECT_EQ(after[2].cells[0].id, before[0].cells[0].id);
}

TEST(TrackCells, IdsOfCellsAtOnePlaceDiffer) {
    const auto scans = tracked({drawn_scan(0, {{0, 0}, {0, 0}, {0, 0}})});
    EXPECT_NE(scans[0].cells[0].id, scans[0].cells[1].id);
    EXPECT_NE(scans[0].cells[1].id, scans[0].cells[2].id);
}

TEST(TrackCells, WithoutMotionThereAreNoForecasts) {
    const auto scans = tracked({drawn_scan(0, {{0, 0}})});
    EXPECT_FALSE(scans[0].cells.at(0).motion);
    EXPECT_TRUE(scans[0].cells.at(0).forecasts.empty());
}

TEST(TrackCells, GridsMayDiffer) {
    CellScan shifted = drawn_scan(5, {{6, 0}});
    shifted.spec.nx = 200;
    const auto scans = tracked({drawn_scan(0, {{0, 0}}), shifted});
    EXPECT_EQ(scans[1].cells.at(0).id, scans[0].cells.at(0).id);
}

TEST(TrackCells, NoScansGiveNothing) {
    EXPECT_TRUE(tracked({}).empty());
    EXPECT_TRUE(tracked({drawn_scan(0, {})}).at(0).cells.empty());
}

TEST(TrackCells, BadArgumentsAreErrors) {
    std::vector<CellScan> scans = {drawn_scan(0, {{0, 0}}), drawn_scan(5, {{0, 0}})};
    scans[1].area = "KFWS";
    EXPECT_EQ(track_cells(scans).error().code, ErrorCode::bad_argument);
    scans[1].area = "KTLX";
    TrackOptions options;
    options.longest_gap_s = std::nan("");
    EXPECT_FALSE(track_cells(scans, options));
    options = {};
    options.most_positions = 1;
    EXPECT_FALSE(track_cells(scans, options));
    scans[1].spec.nx = 0;
    EXPECT_FALSE(track_cells(scans));
}

}  // namespace
}  // namespace stormcellar::retrieve
