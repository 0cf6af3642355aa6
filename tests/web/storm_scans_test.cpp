// Tests that the storms of grids are found and tracked, and that each grid is searched once.
#include "web/data/storms/storm_scans.h"

#include <gtest/gtest.h>

#include "tests/web/served_storms.h"

namespace stormcellar::web {
namespace {

using testing::noon;

StormArea area_of(const ServedStorms& served, const std::string& name) {
    const auto areas = storm_areas(*served.grids(), {.area = name});
    EXPECT_TRUE(areas);
    return areas ? areas->front() : StormArea{};
}

TEST(StormScans, TrackAStorm) {
    ServedStorms served;
    served.add_half_hour("KTLX");
    const auto tracked = served.scans()->track(area_of(served, "KTLX"));
    ASSERT_TRUE(tracked) << tracked.error().message;
    EXPECT_EQ(tracked->area, "KTLX");
    EXPECT_EQ(tracked->time, noon + std::chrono::minutes{25});
    ASSERT_EQ(tracked->cells.size(), 1U);
    const retrieve::TrackedCell& storm = tracked->cells.front();
    EXPECT_EQ(storm.past.size(), 5U);
    ASSERT_TRUE(storm.motion);
    EXPECT_NEAR(storm.motion->velocity.u_mps, ServedStorms::storm_mps, 2);
    EXPECT_NEAR(storm.motion->velocity.v_mps, 0, 2);
    EXPECT_TRUE(storm.cell.top_is_at_least) << "the grid ends within the storm";
    EXPECT_FALSE(storm.cell.azimuthal_shear_per_s);
}

TEST(StormScans, SearchEachGridOnce) {
    ServedStorms served;
    served.add_half_hour("KTLX");
    for (int i = 0; i < 2; ++i)
        ASSERT_TRUE(served.scans()->track(area_of(served, "KTLX")));
    EXPECT_EQ(served.scans()->searched(), 6U);
    served.add("KTLX", 30);
    ASSERT_TRUE(served.scans()->track(area_of(served, "KTLX")));
    EXPECT_EQ(served.scans()->searched(), 7U);
    served.add("KTLX", 30, 0);  // the grid is made again
    (void)served.grids()->changes();
    const auto again = served.scans()->track(area_of(served, "KTLX"));
    ASSERT_TRUE(again);
    EXPECT_EQ(served.scans()->searched(), 8U);
    EXPECT_GT(again->cells.front().cell.position.longitude_deg, -97.2);
}

TEST(StormScans, KeepLittleMemory) {
    ServedStorms served;
    served.add_half_hour("KTLX");
    StormScans scans(served.grids(), {}, 1);  // keeps only the newest scan
    for (int i = 0; i < 2; ++i) {
        const auto tracked = scans.track(area_of(served, "KTLX"));
        ASSERT_TRUE(tracked);
        EXPECT_EQ(tracked->cells.size(), 1U);
    }
    EXPECT_EQ(scans.searched(), 12U);
}

TEST(StormScans, TakeTheShearOfTheSameTime) {
    ServedStorms served;
    served.add("KTLX", 0);
    grid::Grid shear = storm_grid(noon, -20);
    shear.moment = level2::Moment::azsh;
    for (float& value : shear.values)
        value = std::min(value, 12.0F);
    served.add("KTLX", shear);
    const auto tracked = served.scans()->track(area_of(served, "KTLX"));
    ASSERT_TRUE(tracked);
    ASSERT_EQ(tracked->cells.size(), 1U);
    ASSERT_TRUE(tracked->cells.front().cell.azimuthal_shear_per_s);
    EXPECT_NEAR(*tracked->cells.front().cell.azimuthal_shear_per_s, 0.012, 1e-4);
}

TEST(StormScans, LeaveOutEvictedGrids) {
    ServedStorms served;
    served.add_half_hour("KTLX");
    const StormArea before = area_of(served, "KTLX");
    const auto entries = *served.store().list("KTLX", level2::Moment::ref, {}, {});
    ASSERT_TRUE(served.store().remove(entries.front()));
    const auto tracked = served.scans()->track(before);
    ASSERT_TRUE(tracked) << tracked.error().message;
    ASSERT_EQ(tracked->cells.size(), 1U);
    EXPECT_EQ(tracked->cells.front().past.size(), 4U);
    for (const auto& entry : entries)
        (void)served.store().remove(entry);
    const auto none = served.scans()->track(before);
    ASSERT_TRUE(none) << none.error().message;
    EXPECT_TRUE(none->cells.empty());
}

}  // namespace
}  // namespace stormcellar::web
