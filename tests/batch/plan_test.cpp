// Tests that a plan is the same every time, and that each task can be read alone.
#include "batch/plan.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/batch/small_archive.h"

namespace stormcellar::batch {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::chrono::sys_days day(const std::string& text) {
    return std::chrono::floor<std::chrono::days>(at(text));
}

Recipe recipe_of_two_days() {
    Recipe recipe = recipe_between("2013-05-20T23:30Z", "2013-05-21T01:30Z");
    recipe.domain->overlap = grid::Overlap::nearest;
    return recipe;
}

std::vector<StationDay> days_of_three_stations() {
    std::vector<StationDay> days;
    for (const char* date : {"2013-05-20", "2013-05-21"}) {
        for (const char* station : {"KFDR", "KTLX", "KVNX"})
            days.push_back({day(date), station, {"2013/a b", station}, 7, 70'000'000});
    }
    return days;
}

TEST(Plan, HasGridTasksByDayAndStationThenFramesByHour) {
    const testing::TemporaryDirectory directory;
    ASSERT_TRUE(write_plan(directory / "plan", recipe_of_two_days(), days_of_three_stations()));
    const auto plan = Plan::open(directory / "plan");
    ASSERT_TRUE(plan) << plan.error().message;
    EXPECT_EQ(plan->facts().grid_tasks, 6U);
    EXPECT_EQ(plan->facts().frame_tasks, 3U);
    EXPECT_EQ(plan->facts().volumes, 42U);
    const auto second = std::get<StationDay>(plan->task(1)->work);
    EXPECT_EQ(second.station, "KTLX");
    EXPECT_EQ(second.day, day("2013-05-20"));
    EXPECT_THAT(second.in, ElementsAre("2013/a b", "KTLX"));
    EXPECT_EQ(plan->task(1)->cost_s, 2) << "70 MB at 35 MB/s";

    // The hour before midnight needs both days, because its frames use volumes that begin up to 25
    // minutes later.
    const auto evening = std::get<FrameHour>(plan->task(6)->work);
    EXPECT_EQ(evening.from, at("2013-05-20T23:30Z"));
    EXPECT_EQ(evening.first_need, 0U);
    EXPECT_EQ(evening.end_need, 6U);
    const auto last = std::get<FrameHour>(plan->task(8)->work);
    EXPECT_EQ(last.from, at("2013-05-21T01:00Z"));
    EXPECT_EQ(last.to, at("2013-05-21T01:30Z"));
    EXPECT_EQ(last.first_need, 3U);
    EXPECT_EQ(plan->task(9).error().code, ErrorCode::bad_argument);
}

TEST(Plan, IsTheSameEveryTimeAndRefusesAnother) {
    const testing::TemporaryDirectory directory;
    const Recipe recipe = recipe_of_two_days();
    ASSERT_TRUE(write_plan(directory / "a", recipe, days_of_three_stations()));
    ASSERT_TRUE(write_plan(directory / "b", recipe, days_of_three_stations()));
    EXPECT_EQ(tree_of(directory / "a"), tree_of(directory / "b"));
    EXPECT_TRUE(write_plan(directory / "a", recipe, days_of_three_stations()));

    auto fewer = days_of_three_stations();
    fewer.pop_back();
    const Status other = write_plan(directory / "a", recipe, fewer);
    ASSERT_FALSE(other);
    EXPECT_THAT(other.error().message, HasSubstr("is another plan"));
    EXPECT_EQ(write_plan(directory / "c", recipe, {}).error().code, ErrorCode::not_found);
}

TEST(Plan, ReadsBackTheRecipeThatWasWritten) {
    const testing::TemporaryDirectory directory;
    for (const bool own : {false, true}) {
        Recipe recipe = recipe_of_two_days();
        recipe.moments = {level2::Moment::ref, level2::Moment::vel};
        recipe.domain->moments = recipe.moments;
        recipe.domain->spec.center_latitude_deg = 35.1 + 1e-13;
        recipe.derived.quality = own ? 0.1 + 0.2 : 0;
        recipe.derived.dealiasing =
            own ? retrieve::Dealiasing::region : retrieve::Dealiasing::automatic;
        if (own) recipe.derived.motion = *retrieve::motion_choice_from("240/15.5");
        if (own) {
            recipe.domain.reset();
            recipe.levels_m = {500, 1000.25};
            recipe.spacing_m = 333.3;
        }
        const fs::path place = directory / (own ? "own" : "mosaic");
        ASSERT_TRUE(write_plan(place, recipe, days_of_three_stations()));
        const auto plan = Plan::open(place);
        ASSERT_TRUE(plan) << plan.error().message;
        EXPECT_EQ(plan->recipe().domain, recipe.domain);
        EXPECT_EQ(plan->recipe().levels_m, recipe.levels_m);
        EXPECT_EQ(plan->recipe().spacing_m, recipe.spacing_m);
        EXPECT_EQ(plan->recipe().moments, recipe.moments);
        EXPECT_EQ(plan->recipe().derived.quality, recipe.derived.quality);
        EXPECT_EQ(plan->recipe().derived.dealiasing, recipe.derived.dealiasing);
        EXPECT_EQ(retrieve::motion_choice_text(plan->recipe().derived.motion),
                  own ? "240/15.5" : "right");
        EXPECT_EQ(plan->recipe().from, recipe.from);
        EXPECT_EQ(plan->facts().hash, hash_of(recipe));
    }
}

TEST(Plan, ADamagedPlanIsToldFromAMissingOne) {
    const testing::TemporaryDirectory directory;
    EXPECT_EQ(Plan::open(directory / "none").error().code, ErrorCode::not_found);
    ASSERT_TRUE(write_plan(directory / "a", recipe_of_two_days(), days_of_three_stations()));
    const fs::path path = directory / "a" / Plan::file_name;
    const auto bytes = *read_file(path);
    // Cut the line of the last task, then the first line.
    fs::resize_file(path, bytes.size() - 30);
    EXPECT_EQ(Plan::open(directory / "a")->task(8).error().code, ErrorCode::corrupt);
    EXPECT_TRUE(Plan::open(directory / "a")->task(7));
    fs::resize_file(path, 40);
    EXPECT_EQ(Plan::open(directory / "a").error().code, ErrorCode::corrupt);
    std::ofstream(path, std::ios::trunc) << "{\"version\":99,\"software\":\"x\"}\n";
    EXPECT_EQ(Plan::open(directory / "a").error().code, ErrorCode::unsupported);
}

}  // namespace
}  // namespace stormcellar::batch
