// Follows a storm through grids in a cache.
#include "notify/area_watch.h"

#include <fstream>

#include <gtest/gtest.h>

#include "tests/notify/storm_grids.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::notify {
namespace {

using std::chrono::minutes;

const UtcTime watch_time = *parse_utc("2024-06-01T22:00", UtcTime{});

class AreaOfAStorm : public ::testing::Test {
  protected:
    // Looks until all grids are read, or until there are cells.
    std::optional<retrieve::TrackedScan> look(UtcTime now) {
        std::optional<retrieve::TrackedScan> found;
        for (int i = 0; i < 6 && !found; ++i) {
            auto scan = watch_.look(now);
            EXPECT_TRUE(scan) << scan.error().message;
            if (scan) found = std::move(*scan);
        }
        return found;
    }
    testing::TemporaryDirectory directory_;
    AreaWatch watch_{directory_ / "cache", "KTLX", {}};
};

TEST_F(AreaOfAStorm, FindsTheStormWithItsTrack) {
    testing::commit_moving_storm(directory_ / "cache", "KTLX", watch_time, 10, 20);
    const auto scan = look(watch_time + minutes{1});
    ASSERT_TRUE(scan);
    EXPECT_EQ(scan->time, watch_time);
    ASSERT_EQ(scan->cells.size(), 1U);
    const retrieve::TrackedCell& cell = scan->cells[0];
    EXPECT_EQ(cell.past.size(), 9U) << "the watch reads more grids than one call does";
    EXPECT_TRUE(cell.cell.mesh_mm);
    const grid::SiteFrame frame(testing::storm_center.latitude_deg,
                                testing::storm_center.longitude_deg);
    EXPECT_NEAR(frame.to_polar(cell.cell.position).arc_m, 20'000, 500);
    ASSERT_TRUE(cell.motion);
    EXPECT_NEAR(cell.motion->velocity.u_mps, testing::storm_speed_mps, 2);
    EXPECT_NEAR(cell.motion->velocity.v_mps, 0, 2);
}

TEST_F(AreaOfAStorm, ReportsEachGridOnce) {
    testing::commit_moving_storm(directory_ / "cache", "KTLX", watch_time, 2, 0);
    const auto first = look(watch_time);
    ASSERT_TRUE(first);
    EXPECT_FALSE(look(watch_time));
    watch_.report_again();
    EXPECT_TRUE(look(watch_time));
    testing::commit_storm(directory_ / "cache", "KTLX", watch_time + minutes{5}, {.east_km = 4.5});
    const auto next = look(watch_time + minutes{5});
    ASSERT_TRUE(next);
    EXPECT_EQ(next->time, watch_time + minutes{5});
    ASSERT_EQ(next->cells.size(), 1U);
    EXPECT_EQ(next->cells[0].id, first->cells[0].id);
}

// After a restart, the cells must have the same ids, or the same messages would be sent again.
TEST_F(AreaOfAStorm, ARestartGivesTheSameIds) {
    testing::commit_moving_storm(directory_ / "cache", "KTLX", watch_time, 4, 0);
    const auto before = look(watch_time);
    ASSERT_TRUE(before);
    AreaWatch again(directory_ / "cache", "KTLX", {});
    const auto after = again.look(watch_time);
    ASSERT_TRUE(after && *after);
    EXPECT_EQ((*after)->cells[0].id, before->cells[0].id);
}

TEST_F(AreaOfAStorm, AGridThatWillBeReplacedCountsWhenThereIsALaterOne) {
    testing::commit_storm(directory_ / "cache", "KTLX", watch_time, {.is_partial = true});
    EXPECT_FALSE(look(watch_time));
    testing::commit_storm(directory_ / "cache", "KTLX", watch_time + minutes{5},
                          {.east_km = 4.5, .is_partial = true});
    const auto first = look(watch_time + minutes{5});
    ASSERT_TRUE(first);
    EXPECT_EQ(first->time, watch_time);
    testing::commit_storm(directory_ / "cache", "KTLX", watch_time + minutes{5}, {.east_km = 4.5});
    const auto next = look(watch_time + minutes{6});
    ASSERT_TRUE(next);
    EXPECT_EQ(next->time, watch_time + minutes{5});
}

TEST_F(AreaOfAStorm, OldGridsAreNoNews) {
    testing::commit_moving_storm(directory_ / "cache", "KTLX", watch_time, 2, 0);
    EXPECT_FALSE(look(watch_time + AreaWatch::oldest_news + minutes{1}));
}

TEST_F(AreaOfAStorm, ADamagedGridIsLeftOut) {
    testing::commit_moving_storm(directory_ / "cache", "KTLX", watch_time, 3, 0);
    const auto store = cache::StoreReader::open(directory_ / "cache");
    const auto path = store->path_of("KTLX", level2::Moment::ref, watch_time - minutes{5});
    std::ofstream(*path) << "no grid";
    const auto scan = look(watch_time);
    ASSERT_TRUE(scan);
    EXPECT_EQ(scan->cells.size(), 1U);
}

TEST_F(AreaOfAStorm, ACacheThatIsMissingIsAnErrorUntilItComes) {
    EXPECT_FALSE(watch_.look(watch_time));
    testing::commit_moving_storm(directory_ / "cache", "other", watch_time, 1, 0);
    EXPECT_FALSE(look(watch_time)) << "no grid of the area";
}

}  // namespace
}  // namespace stormcellar::notify
