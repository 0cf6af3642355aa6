// Tests check(), which reads the records of tasks to tell which tasks of a plan are done.
#include "batch/check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "batch/record.h"
#include "tests/batch/small_archive.h"

namespace stormcellar::batch {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

class BatchCheck : public SmallArchive {};

TEST_F(BatchCheck, SaysWhatIsMissingDoneAndLeft) {
    const Plan plan = plan_of(recipe("one"), "plan");
    const auto none = check(plan, {});
    ASSERT_TRUE(none);
    EXPECT_THAT(none->missing, ElementsAre(0, 1, 2));
    EXPECT_FALSE(none->seconds_left);
    EXPECT_EQ(none->cost_left_s, plan.facts().cost_s);
    ASSERT_TRUE(run(plan, 0));
    const auto some = check(plan, {});
    EXPECT_THAT(some->missing, ElementsAre(1, 2));
    EXPECT_EQ(some->done.grid_tasks, 1U);
    EXPECT_EQ(some->done.stations.at("KBGM").taken[2], 3U);
    ASSERT_TRUE(some->seconds_left);
    EXPECT_GT(*some->seconds_left, 0);
    run_all(plan);
    const auto all = check(plan, {});
    EXPECT_THAT(all->missing, IsEmpty());
    EXPECT_EQ(*all->seconds_left, 0);
}

TEST_F(BatchCheck, ASummaryStandsForItsRecords) {
    const Plan plan = plan_of(recipe("one"), "plan");
    run_all(plan);
    const fs::path summary = plan.directory() / "tasks/00000/summary.json";
    ASSERT_TRUE(fs::exists(summary)) << "the task that ends last writes the summary";
    fs::remove(summary);
    const auto records = check(plan, {});
    ASSERT_TRUE(fs::exists(summary));
    const auto bytes = *read_file(summary);
    fs::remove(record_path(plan.directory(), 1));
    const auto summed = check(plan, {});
    EXPECT_THAT(summed->missing, IsEmpty()) << "check() takes the summary instead of the records";
    EXPECT_EQ(summed->done.cpu_s, records->done.cpu_s);
    EXPECT_EQ(summed->done.stations.at("KBGM").taken, records->done.stations.at("KBGM").taken);
    EXPECT_EQ(summed->done.started, records->done.started);
    EXPECT_EQ(*read_file(summary), bytes);
    EXPECT_THAT(check(plan, {true, {}})->missing, ElementsAre(1))
        << "a deep check reads the records";
    // A damaged summary is written again.
    fs::resize_file(summary, 20);
    ASSERT_TRUE(run(plan, 1));
    EXPECT_THAT(check(plan, {})->missing, IsEmpty());
    EXPECT_GT(fs::file_size(summary), 20U);
}

TEST_F(BatchCheck, ADeepCheckComparesTheGrids) {
    const Plan plan = plan_of(recipe("one"), "plan");
    run_all(plan);
    EXPECT_THAT(check(plan, {true, {}})->missing, IsEmpty());
    for (const auto& entry : fs::directory_iterator(directory_ / "one/north.KBGM/REF/20050822")) {
        fs::remove(entry.path());
        break;
    }
    const auto report = check(plan, {true, {}});
    EXPECT_THAT(report->changed, ElementsAre(0));
    EXPECT_THAT(report->missing, ElementsAre(0));
    ASSERT_TRUE(run(plan, 0));
    EXPECT_THAT(check(plan, {true, {}})->missing, IsEmpty());
}

}  // namespace
}  // namespace stormcellar::batch
