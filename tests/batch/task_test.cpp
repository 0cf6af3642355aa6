// Tests that tasks make the same bytes wherever they run, however often, and in however many steps.
#include <cstdlib>
#include <fstream>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/host_name.h"
#include "batch/check.h"
#include "batch/leftovers.h"
#include "batch/record.h"
#include "pipeline/ingest/ingest.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/cache/store.h"
#include "stormcellar/catalog/catalog.h"
#include "tests/batch/failing_reads.h"
#include "tests/batch/small_archive.h"
#include "tests/fetch/mock_bucket.h"
#include "tests/testing/file_bytes.h"
#include "tests/testing/waiting.h"

namespace stormcellar::batch {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class BatchTasks : public SmallArchive {
  protected:
    [[nodiscard]] fs::path partials(const std::string& cache) const {
        return directory_ / cache / "north.KBGM/REF/20050822";
    }
    // Expects that the task failed, but that another try may succeed.
    static void expect_unreadable(const Result<TaskOutcome>& outcome,
                                  const std::string& part = "") {
        ASSERT_FALSE(outcome);
        EXPECT_EQ(outcome.error().code, ErrorCode::io) << outcome.error().message;
        EXPECT_THAT(outcome.error().message, HasSubstr(part));
    }
};

TEST_F(BatchTasks, ASecondRunFindsWhatStandsAndASecondCacheHasTheSameBytes) {
    const Plan plan = plan_of(recipe("one"), "plan-one");
    ASSERT_EQ(plan.facts().grid_tasks, 1U);
    ASSERT_EQ(plan.facts().frame_tasks, 2U);  // 02:45 to 02:59, and 03:00
    const auto grids = run(plan, 0);
    ASSERT_TRUE(grids) << grids.error().message;
    EXPECT_FALSE(grids->stood);
    EXPECT_EQ(grids->record.files, 3U);
    EXPECT_EQ(grids->record.grids, 3U);
    EXPECT_THAT(grids->record.left_out, IsEmpty());
    EXPECT_EQ(grids->record.taken_by_hour[2], 3U);
    EXPECT_GT(grids->record.cpu_s, 0);
    EXPECT_GT(grids->record.bytes_read, 1'000'000U);
    EXPECT_GT(grids->record.bytes_written, 0U);
    EXPECT_EQ(grids->record.host, host_name());
    const auto frames = run(plan, 1);
    ASSERT_TRUE(frames) << frames.error().message;
    EXPECT_GT(frames->record.grids, 8U);
    ASSERT_TRUE(run(plan, 2));

    const auto bytes = tree_of(directory_ / "one");
    EXPECT_TRUE(run(plan, 0)->stood);
    EXPECT_TRUE(run(plan, 1)->stood);
    const Plan other = plan_of(recipe("two"), "plan-two");
    run_all(other);
    EXPECT_EQ(tree_of(directory_ / "one"), bytes);
    EXPECT_EQ(tree_of(directory_ / "two"), bytes);
}

// 2026-11-30: a batch could neither leave out echo that is not weather nor dealias, as the daemon
// does.
TEST_F(BatchTasks, GridsOfWeatherAndOfDealiasedVelocitiesAreThoseOfTheDaemon) {
    Recipe recipe = this->recipe("weather");
    recipe.domain.reset();
    recipe.spacing_m = 4000;
    recipe.nx = recipe.ny = 120;
    recipe.levels_m = {1000, 2000, 4000};
    recipe.moments = {level2::Moment::ref, level2::Moment::veld};
    recipe.derived.quality = 0.5;
    recipe.derived.dealiasing = retrieve::Dealiasing::region;
    run_all(plan_of(recipe, "plan"));
    auto catalog = catalog::CatalogWriter::open(directory_ / "catalog");
    auto kept = cache::StoreWriter::open(real_file_system(), directory_ / "kept", true);
    pipeline::IngestOptions ingest;
    ingest.moments = recipe.moments;
    ingest.derived = recipe.derived;
    ingest.spacing_m = 4000;
    ingest.nx = ingest.ny = 120;
    ingest.levels_m = recipe.levels_m;
    pipeline::Ingestor ingestor(*catalog, *kept, ingest);
    // The first volume of the sequence begins before the recipe's first hour.
    for (const std::string& name : {pipeline::sequence[1], pipeline::sequence[2]})
        ASSERT_TRUE(ingestor.ingest(raw_ / "day" / name, false));
    const auto daemons = tree_of(directory_ / "kept");
    EXPECT_EQ(tree_of(directory_ / "weather"), daemons);
    // A plan that keeps all echo makes its own grids, although the cache is the same.
    recipe.derived.quality = 0;
    run_all(plan_of(recipe, "plan of all echo"));
    EXPECT_NE(tree_of(directory_ / "weather"), daemons);
}

// An engine may start a task twice. Here two processes run one task at the same time.
TEST_F(BatchTasks, TwoAtTheSameTimeLeaveTheBytesOfOne) {
    run_all(plan_of(recipe("one"), "plan-one"));
    const Plan plan = plan_of(recipe("two"), "plan-two");
    for (std::size_t number = 0; number < plan.facts().tasks(); ++number) {
        std::vector<pid_t> children;
        for (int copy = 0; copy < 2; ++copy) {
            children.push_back(::fork());
            if (children.back() == 0) ::_exit(run(plan, number) ? 0 : 1);
        }
        for (const pid_t child : children) {
            int status = 0;
            ASSERT_EQ(::waitpid(child, &status, 0), child);
            EXPECT_EQ(status, 0);
        }
    }
    EXPECT_EQ(tree_of(directory_ / "two"), tree_of(directory_ / "one"));
}

TEST_F(BatchTasks, AKilledTaskContinuesWithTheFileThatItWasAt) {
    const Plan whole = plan_of(recipe("one"), "plan-one");
    run_all(whole);
    // The killed task did not finish the grid of its third file and left a temporary file.
    const Plan plan = plan_of(recipe("two"), "plan-two");
    run_all(plan);
    ASSERT_TRUE(fs::remove(record_path(plan.directory(), 0)));
    std::vector<fs::path> grids;
    for (const auto& entry : fs::directory_iterator(partials("two")))
        grids.push_back(entry.path());
    std::ranges::sort(grids);
    ASSERT_THAT(grids, SizeIs(3));
    fs::remove(grids[2]);
    const pid_t ended = ::fork();
    if (ended == 0) ::_exit(0);
    ASSERT_EQ(::waitpid(ended, nullptr, 0), ended);
    const auto leftover = [&](const std::string& host, pid_t process) {
        const fs::path path =
            partials("two") / fmt::format("{}{}-{}-0", temporary_prefix, host, process);
        std::ofstream(path) << "half";
        return path;
    };
    const fs::path own = leftover(host_name(), ended);
    const fs::path running = leftover(host_name(), ::getpid());
    const fs::path of_other = leftover("elsewhere", ended);
    const auto again = run(plan, 0);
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_LT(again->record.bytes_read, fs::file_size(raw_ / "day" / pipeline::sequence[0]) +
                                            fs::file_size(raw_ / "day" / pipeline::sequence[1]) +
                                            fs::file_size(raw_ / "day" / pipeline::sequence[2]))
        << "the first file need not be read again";
    EXPECT_EQ(again->record.taken_by_hour[2], 3U);
    EXPECT_FALSE(fs::exists(own));
    EXPECT_TRUE(fs::exists(running)) << "another process of this host may be writing the file";
    EXPECT_TRUE(fs::exists(of_other)) << "another host may be writing the file";
    EXPECT_EQ(remove_all_leftovers(plan), 2U);
    EXPECT_EQ(tree_of(directory_ / "two"), tree_of(directory_ / "one"));
}

TEST_F(BatchTasks, ABadVolumeIsLeftOutWithItsReason) {
    std::ofstream(raw_ / "day" / pipeline::sequence[1], std::ios::trunc)
        << "some bytes that are no radar data";
    const Plan plan = plan_of(recipe("one"), "plan");
    const auto outcome = run(plan, 0);
    ASSERT_TRUE(outcome) << outcome.error().message;
    EXPECT_EQ(outcome->record.grids, 2U);
    ASSERT_THAT(outcome->record.left_out, SizeIs(1));
    EXPECT_EQ(outcome->record.left_out[0].name, pipeline::sequence[1]);
    EXPECT_NE(outcome->record.left_out[0].reason, "");
    EXPECT_EQ(outcome->record.left_out_by_hour[2], 1U);
    EXPECT_TRUE(run(plan, 0)->stood);
    EXPECT_THAT(run(plan, 0)->record.left_out, SizeIs(1));
}

TEST_F(BatchTasks, FramesWaitForTheRecordsOfTheirGrids) {
    const Plan plan = plan_of(recipe("one"), "plan");
    const auto early = run(plan, 1);
    ASSERT_FALSE(early);
    EXPECT_EQ(early.error().code, ErrorCode::unmet);
    EXPECT_THAT(early.error().message, HasSubstr("needs task 0, which is not done"));
    // A record of another recipe does not count.
    Record other;
    other.number = 0;
    other.plan = "0";
    other.station = "KBGM";
    other.day = "20050822";
    ASSERT_TRUE(write_record(plan.directory(), other));
    EXPECT_EQ(run(plan, 1).error().code, ErrorCode::unmet);
    ASSERT_TRUE(run(plan, 0));
    EXPECT_TRUE(run(plan, 1));
}

TEST_F(BatchTasks, WhatMayPassIsAnErrorOfTheSystem) {
    const Plan plan = plan_of(recipe("one"), "plan");
    stop_ = true;
    EXPECT_EQ(run(plan, 0).error().code, ErrorCode::busy);
    stop_ = false;
    fs::rename(raw_, directory_ / "unmounted");
    const auto without = run(plan, 0);
    ASSERT_FALSE(without);
    EXPECT_EQ(without.error().cause(), Cause::system);
    EXPECT_FALSE(fs::exists(record_path(plan.directory(), 0)));
}

// 2026-11-29: while the source was not mounted, a task found an empty directory and counted as done
// for good.
TEST_F(BatchTasks, ASourceThatLacksFilesOfThePlanMayCome) {
    const Plan plan = plan_of(recipe("one"), "plan");
    fs::rename(raw_ / "day", directory_ / "unmounted");
    fs::create_directory(raw_ / "day");
    expect_unreadable(run(plan, 0), "has 0 of the 3 files that the plan counted");
    EXPECT_FALSE(fs::exists(record_path(plan.directory(), 0)));
    fs::remove(raw_ / "day");
    fs::rename(directory_ / "unmounted", raw_ / "day");
    EXPECT_EQ(run(plan, 0)->record.grids, 3U);
}

// 2026-11-29: a file that could not be read was left out for good, and its task counted as done.
TEST_F(BatchTasks, AFileThatCannotBeReadMayBeReadLater) {
    const Plan plan = plan_of(recipe("one"), "plan");
    {
        const testing::FailingReads reads(pipeline::sequence[1]);
        expect_unreadable(run(plan, 0), pipeline::sequence[1]);
    }
    EXPECT_FALSE(fs::exists(record_path(plan.directory(), 0)));
    run_all(plan);
    const Plan other = plan_of(recipe("two"), "plan-two");
    run_all(other);
    EXPECT_EQ(tree_of(directory_ / "one"), tree_of(directory_ / "two"));
}

// 2026-11-29: members of a tar that could not be read for a while were left out for good.
TEST_F(BatchTasks, ATarThatCannotBeReadMayBeReadLater) {
    fs::create_directory(directory_ / "tars");
    const std::string command = fmt::format("tar -C {} -cf {} day", raw_.native(),
                                            (directory_ / "tars/20050822.tar").native());
    ASSERT_EQ(std::system(command.c_str()), 0);
    Recipe from_tar = recipe("one");
    from_tar.source = (directory_ / "tars").native();
    const Plan plan = plan_of(from_tar, "plan");
    {
        const testing::FailingReads reads("20050822.tar");
        expect_unreadable(run(plan, 0));
        const auto listing = list_source(from_tar.source, from_tar.from, from_tar.to);
        ASSERT_FALSE(listing);
        EXPECT_EQ(listing.error().code, ErrorCode::io) << listing.error().message;
    }
    EXPECT_EQ(run(plan, 0)->record.grids, 3U);
}

// 2026-11-29: frames were made without a station's grid that could not be read, and were never made
// again.
TEST_F(BatchTasks, FramesWaitForAGridThatCannotBeRead) {
    run_all(plan_of(recipe("one"), "plan-one"));
    const Plan plan = plan_of(recipe("two"), "plan-two");
    ASSERT_TRUE(run(plan, 0));
    std::vector<fs::path> grids;
    for (const auto& entry : fs::directory_iterator(partials("two")))
        grids.push_back(entry.path());
    std::ranges::sort(grids);
    ASSERT_THAT(grids, SizeIs(3));
    {
        const testing::FailingReads reads(grids[0].filename());
        expect_unreadable(run(plan, 1));
    }
    EXPECT_FALSE(fs::exists(record_path(plan.directory(), 1)));
    run_all(plan);
    EXPECT_EQ(tree_of(directory_ / "two"), tree_of(directory_ / "one"));
}

// 2026-11-29: on a machine without the cache, tasks made empty frames and empty statistics, and
// counted as done for good.
TEST_F(BatchTasks, FramesAndStatisticsWaitForTheGridsOfTheirRecords) {
    Recipe counted = recipe("one");
    counted.statistics = grid::Tallied::columns;
    const Plan plan = plan_of(counted, "plan");
    ASSERT_TRUE(run(plan, 0));
    fs::rename(directory_ / "one", directory_ / "unmounted");
    fs::create_directory(directory_ / "one");
    expect_unreadable(run(plan, 1), "has 0 of the 3 grids that task 0 made");
    fs::remove_all(directory_ / "one");
    fs::rename(directory_ / "unmounted", directory_ / "one");
    ASSERT_TRUE(run(plan, 1));
    ASSERT_TRUE(run(plan, 2));
    fs::remove_all(directory_ / "one/north");
    EXPECT_EQ(run(plan, 3).error().code, ErrorCode::io);
}

// 2026-11-29: if a day's grids were lost, grids of the next day's first two hours were counted in
// their place.
TEST_F(BatchTasks, GridsOfTheNextDayDoNotStandForThoseOfADay) {
    const Plan plan = plan_of(recipe("one"), "plan");
    ASSERT_TRUE(run(plan, 0));
    auto store = cache::StoreWriter::open(real_file_system(), directory_ / "one", false);
    const auto grids = store->list("north.KBGM", level2::Moment::ref, std::nullopt, std::nullopt);
    ASSERT_THAT(*grids, SizeIs(3));
    {
        const auto lost = cache::GridFile::open(grids->at(1).path);
        cache::GridDescription next = lost->description();
        next.time = at("2005-08-23T00:10Z");
        next.provenance.source_files = {"KBGM20050823_001000"};
        ASSERT_TRUE(store->commit("north.KBGM", next, lost->view()));
    }
    fs::remove(grids->at(1).path);
    expect_unreadable(run(plan, 1), "has 2 of the 3 grids that task 0 made");
}

// A grid that another plan made for this day does no harm beside our grids, but is an error in the
// place of one of our grids.
TEST_F(BatchTasks, AnotherPlansGridOfTheDayDoesNotStandForOurs) {
    const Plan plan = plan_of(recipe("one"), "plan");
    ASSERT_TRUE(run(plan, 0));
    auto store = cache::StoreWriter::open(real_file_system(), directory_ / "one", false);
    const auto grids = store->list("north.KBGM", level2::Moment::ref, std::nullopt, std::nullopt);
    {
        const auto ours = cache::GridFile::open(grids->at(1).path);
        cache::GridDescription other = ours->description();
        other.time = at("2005-08-22T23:10Z");
        other.provenance.source_files = {"KBGM20050822_231000"};
        ASSERT_TRUE(store->commit("north.KBGM", other, ours->view()));
    }
    ASSERT_TRUE(run(plan, 1));
    fs::remove(grids->at(1).path);
    const auto frames = run(plan, 1);
    ASSERT_FALSE(frames);
    EXPECT_THAT(frames.error().message, HasSubstr("other grids than task 0 made"));
}

// 2026-11-29: a cache that was mounted while a task ran hid the task's first grids, and no check
// noticed.
TEST_F(BatchTasks, ACacheThatIsReplacedMeanwhileLeavesATaskUndone) {
    const Plan plan = plan_of(recipe("one"), "plan");
    std::thread mount([&] {
        EXPECT_TRUE(testing::eventually(
            [&] { return fs::exists(partials("one")) && !fs::is_empty(partials("one")); }));
        fs::rename(directory_ / "one", directory_ / "beneath");
        fs::create_directory(directory_ / "one");
    });
    const auto grids = run(plan, 0);
    mount.join();
    ASSERT_FALSE(grids);
    EXPECT_EQ(grids.error().code, ErrorCode::io) << grids.error().message;
    EXPECT_FALSE(fs::exists(record_path(plan.directory(), 0)));
    run_all(plan);
    EXPECT_THAT(check(plan, {true, {}})->changed, IsEmpty());
}

// 2026-11-29: frames were made without a damaged grid and without a report, and a deep check found
// no fault.
TEST_F(BatchTasks, ADamagedGridIsNamedAndMadeAgain) {
    run_all(plan_of(recipe("one"), "plan-one"));
    const Plan plan = plan_of(recipe("two"), "plan-two");
    ASSERT_TRUE(run(plan, 0));
    const auto grid = cache::StoreReader::open(directory_ / "two")
                          ->list("north.KBGM", level2::Moment::ref, std::nullopt, std::nullopt)
                          ->at(1)
                          .path;
    std::vector<std::byte> bytes = *read_file(grid);
    bytes[bytes.size() - 5] ^= std::byte{4};
    ASSERT_TRUE(write_file_atomically(real_file_system(), grid, bytes));
    EXPECT_THAT(check(plan, {true, {}})->changed, SizeIs(1));
    const auto frames = run(plan, 1);
    ASSERT_TRUE(frames) << frames.error().message;
    ASSERT_THAT(frames->record.left_out, SizeIs(1));
    EXPECT_THAT(frames->record.left_out[0].reason, HasSubstr(grid.native()));
    EXPECT_EQ(check(plan, {})->done.left_out, 1U);
    EXPECT_THAT(check(plan, {true, {}})->changed, SizeIs(2))
        << "the task of the grid, and the task of the frames that lack the grid";
    // 2026-11-29: while a damaged grid could not be made again, frames were made without it.
    fs::rename(raw_ / "day", directory_ / "unmounted");
    fs::create_directory(raw_ / "day");
    EXPECT_EQ(run(plan, 0).error().code, ErrorCode::io);
    EXPECT_EQ(run(plan, 1).error().code, ErrorCode::unmet);
    EXPECT_THAT(check(plan, {})->missing, ::testing::Contains(0U));
    fs::remove(raw_ / "day");
    fs::rename(directory_ / "unmounted", raw_ / "day");
    run_all(plan);
    EXPECT_EQ(tree_of(directory_ / "two"), tree_of(directory_ / "one"));
    EXPECT_THAT(check(plan, {true, {}})->changed, IsEmpty());
}

TEST_F(BatchTasks, MembersOfATarGiveTheGridsOfTheFiles) {
    run_all(plan_of(recipe("one"), "plan-one"));
    fs::create_directory(directory_ / "tars");
    const std::string command =
        fmt::format("tar -C {} -cf {} day", raw_.native(),
                    (directory_ / "tars/NWS_NEXRAD_NXL2_KBGM_20050822.tar").native());
    ASSERT_EQ(std::system(command.c_str()), 0);
    Recipe from_tar = recipe("two");
    from_tar.source = (directory_ / "tars").native();
    const Plan plan = plan_of(from_tar, "plan-two");
    EXPECT_EQ(plan.facts().volumes, 3U);
    run_all(plan);
    EXPECT_EQ(tree_of(directory_ / "two"), tree_of(directory_ / "one"));
}

// Two machines that run plans of one bucket make equal grids, because fetched files have the times
// of the bucket.
TEST_F(BatchTasks, FilesOfABucketAreFetchedGriddedAndRemoved) {
    fetch::MockBucket bucket;
    for (const std::string& name : pipeline::sequence) {
        bucket.put("2005/08/22/KBGM/" + name, testing::file_text(raw_ / "day" / name));
    }
    for (const std::string cache : {"one", "two"}) {
        Recipe fetched = recipe(cache);
        fetched.source = bucket.address();
        const fs::path place = directory_ / ("plan-" + cache);
        ASSERT_TRUE(
            write_plan(place, fetched, every_day_of({"KBGM"}, fetched.from, fetched.to).days));
        const Plan plan = std::move(*Plan::open(place));
        EXPECT_EQ(plan.facts().volumes, 0U) << "not known before the tasks run";
        const auto outcome = run(plan, 0);
        ASSERT_TRUE(outcome) << outcome.error().message;
        EXPECT_EQ(outcome->record.files, 3U);
        EXPECT_EQ(outcome->record.grids, 3U);
    }
    EXPECT_EQ(tree_of(directory_ / "one"), tree_of(directory_ / "two"));
}

// A task of statistics counts exactly the frames of its month and hour of the day. The order in
// which tasks run does not matter.
TEST_F(BatchTasks, StatisticsCountTheFramesOfAMonthsHour) {
    Recipe counted = recipe("one");
    counted.statistics = grid::Tallied::columns_and_cells;
    const Plan plan = plan_of(counted, "plan-one");
    ASSERT_EQ(plan.facts().statistics_tasks, 2U);  // hours 2 and 3
    EXPECT_EQ(run(plan, 3).error().code, ErrorCode::unmet);
    run_all(plan);
    const auto part = std::get<MonthHour>(plan.task(3)->work);
    EXPECT_EQ(part.hour, 2);
    const auto tally = read_tally(plan, part);
    ASSERT_TRUE(tally) << tally.error().message;
    const auto store = cache::StoreReader::open(counted.cache);
    const auto frames = store->list("north", level2::Moment::ref, at("2005-08-22T02:00Z"),
                                    at("2005-08-22T02:59:59Z"));
    EXPECT_EQ(tally->tally.grids(), frames->size());
    EXPECT_EQ(tally->instants, 15U) << "02:45 to 02:59";
    grid::GridTally again(counted.domain->spec, grid::default_quantization(level2::Moment::ref),
                          grid::Tallied::columns_and_cells);
    for (auto frame = frames->rbegin(); frame != frames->rend(); ++frame)
        ASSERT_TRUE(again.add(cache::GridFile::open(frame->path)->view()));
    EXPECT_EQ(again.to_bytes(), tally->tally.to_bytes());
    EXPECT_THAT(check(plan, {true, {}})->missing, IsEmpty());

    // A damaged file of counts is reported, and the frames are counted again.
    const fs::path path = tally_path(plan, part);
    const auto bytes = *read_file(path);
    fs::resize_file(path, bytes.size() - 1);
    EXPECT_EQ(read_tally(plan, part).error().code, ErrorCode::corrupt);
    EXPECT_THAT(check(plan, {true, {}})->changed, SizeIs(1));
    ASSERT_TRUE(run(plan, 3));
    EXPECT_EQ(*read_file(path), bytes);
}

}  // namespace
}  // namespace stormcellar::batch
