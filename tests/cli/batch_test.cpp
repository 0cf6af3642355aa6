// Runs `stormcellar batch` as a user does.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <signal.h>

#include "stormcellar/base/file_system.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/cache/store.h"
#include "tests/cli/run_stormcellar.h"
#include "tests/pipeline/small_house.h"
#include "tests/testing/file_bytes.h"
#include "tests/testing/waiting.h"

namespace stormcellar::cli {
namespace {

using pipeline::five_volumes;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::ProgramResult;

std::map<std::string, std::string> grids_of(const fs::path& cache) {
    return testing::tree_of(cache, ".scg");
}

class Batch : public ::testing::Test {
  protected:
    void SetUp() override {
        STORMCELLAR_NEED_DATA();
        pipeline::catalog_real_volumes(directory_.path(), five_volumes);
    }
    [[nodiscard]] std::string place(const std::string& name) const {
        return (directory_ / name).string();
    }
    // Returns the options for grids of 4 km, and frames every five minutes.
    [[nodiscard]] static Words grid() {
        return words(
            "--bounds=-79,40,-73,44.5 --spacing-km 4 --levels-km 1:6:1 --interval 5min "
            "--from 2005-08-22T02:50 --to 2005-08-22T03:05");
    }
    [[nodiscard]] ProgramResult plan(const std::string& name, const Words& more = {}) const {
        const Words plan{"batch",    "plan",       "--source", place("drop"),
                         "--mosaic", "KBGM-alone", "-o",       place(name)};
        return run(with(plan, grid(), more));
    }
    [[nodiscard]] ProgramResult batch(const std::string& command, const std::string& name,
                                      const Words& more = {}) const {
        return run(with({"batch", command, "--plan", place(name)}, more));
    }
    // Returns the grids that a loop makes from the same files.
    [[nodiscard]] std::map<std::string, std::string> grids_of_a_loop() const {
        const Words places{"--catalog", place("catalog"), "--cache", place("c"),
                           "-o",        place("a.webp")};
        const auto looped = run(with(
            words("loop --stations KBGM --product composite --width 200 --height 150 --no-labels "
                  "--quiet"),
            places, grid()));
        EXPECT_EQ(looped.status, 0) << looped.err;
        return grids_of(directory_ / "c");
    }

    testing::TemporaryDirectory directory_;
};

TEST_F(Batch, PlansRunsMergesAndChecks) {
    const auto facts = json_of(plan("p", {"--json"}));
    EXPECT_EQ(facts["grid_tasks"], 1);
    EXPECT_EQ(facts["frame_tasks"], 2);
    EXPECT_EQ(facts["volumes"], 5);
    EXPECT_GT(facts["grid_task_memory_bytes"], 100'000'000);
    EXPECT_EQ(batch("check", "p").status, 3) << "no task is done";
    EXPECT_EQ(batch("merge", "p", {"--task", "1"}).status, 1)
        << "the grids that the task needs are not done";
    const ProgramResult ran = batch("run", "p", {"--task", "0"});
    EXPECT_EQ(ran.status, 0) << ran.err;
    EXPECT_THAT(ran.out, HasSubstr("task 0: KBGM 20050822: 5 files, 0 left out, 5 grids"));
    EXPECT_THAT(batch("run", "p", {"--task", "0"}).out, HasSubstr("already done"));
    EXPECT_EQ(batch("merge", "p", {"--task", "1-2"}).status, 0);
    const ProgramResult checked = batch("check", "p", {"--table"});
    EXPECT_EQ(checked.status, 0) << checked.err;
    EXPECT_THAT(checked.out,
                HasSubstr("3 of 3 tasks done (1 of grids, 2 of frames, 0 of statistics)"));
    EXPECT_THAT(checked.out, HasSubstr("KBGM        .     .     3     2     ."));
    const auto document = nlohmann::json::parse(batch("check", "p", {"--json"}).out);
    EXPECT_EQ(document["frames"], 4);
    EXPECT_THAT(document["missing"], IsEmpty());
}

TEST_F(Batch, SaysByItsStatusWhetherAnotherTryHelps) {
    ASSERT_EQ(plan("p").status, 0);
    EXPECT_EQ(batch("run", "p", {"--task", "7"}).status, 2);
    EXPECT_EQ(batch("run", "p", {"--task", "one"}).status, 2);
    EXPECT_EQ(batch("run", "p", {"--task", "1"}).status, 2)
        << "task 1 makes frames, so run refuses task 1";
    EXPECT_EQ(batch("run", "elsewhere", {"--task", "0"}).status, 1);
    fs::rename(directory_ / "drop", directory_ / "unmounted");
    const ProgramResult away = batch("run", "p", {"--task", "0"});
    EXPECT_EQ(away.status, 75) << away.err;
    EXPECT_THAT(away.err, HasSubstr("No such file or directory"));
    fs::rename(directory_ / "unmounted", directory_ / "drop");
    std::ofstream(directory_ / "drop" / five_volumes[2], std::ios::trunc) << "no radar data";
    const ProgramResult bad = batch("run", "p", {"--task", "0"});
    EXPECT_EQ(bad.status, 0) << bad.err;
    EXPECT_THAT(bad.err, HasSubstr("left out: " + five_volumes[2]));
    EXPECT_THAT(batch("check", "p").out, HasSubstr("left out in task 0: " + five_volumes[2]));
}

TEST_F(Batch, IsToTheByteWhatALoopMakes) {
    ASSERT_EQ(plan("p").status, 0);
    const ProgramResult submitted = batch("submit", "p", {"--engine", "local", "--jobs", "2"});
    ASSERT_EQ(submitted.status, 0) << submitted.err;
    EXPECT_EQ(grids_of(directory_ / "p/cache"), grids_of_a_loop());
    EXPECT_THAT(batch("submit", "p", {"--engine", "make"}).out, HasSubstr("all 3 tasks are done"));
}

// The test kills the program and its children as soon as a grid exists.
TEST_F(Batch, ByMakeKilledHalfWayAndRunAgainIsWhatALoopMakes) {
    ASSERT_EQ(plan("p").status, 0);
    const std::string make = "setsid " STORMCELLAR_PROGRAM " batch submit --plan " + place("p") +
                             " --engine make & echo $!; wait";
    testing::RunningProgram killed("/bin/sh", {"-c", make});
    const auto has_grid = [&] { return fs::exists(directory_ / "p/cache/KBGM-alone.KBGM/REF"); };
    ASSERT_TRUE(testing::eventually(has_grid)) << killed.err();
    const pid_t group = std::stoi(killed.out());
    ASSERT_EQ(::kill(-group, SIGKILL), 0);
    static_cast<void>(killed.end(SIGKILL));
    EXPECT_EQ(batch("check", "p").status, 3);
    const ProgramResult again = batch("submit", "p", {"--engine", "make", "--jobs", "2"});
    ASSERT_EQ(again.status, 0) << again.err;
    EXPECT_EQ(grids_of(directory_ / "p/cache"), grids_of_a_loop());
}

TEST_F(Batch, ADryRunPrintsAllAndRunsNothing) {
    ASSERT_EQ(plan("p").status, 0);
    const auto slurm = batch("submit", "p", {"--engine", "slurm", "--dry-run", "--jobs", "9"});
    EXPECT_EQ(slurm.status, 0);
    EXPECT_THAT(slurm.out, HasSubstr("#SBATCH --array=0%9\n"));
    EXPECT_THAT(slurm.out, HasSubstr("sbatch --parsable --dependency=afterany:JOB"));
    EXPECT_THAT(batch("submit", "p", {"--engine", "make", "--dry-run"}).out,
                HasSubstr("GRIDS = grid-0\n"));
    EXPECT_THAT(batch("submit", "p", {"--engine", "local", "--dry-run"}).out,
                HasSubstr("of tasks 0, then 1 2"));
    EXPECT_FALSE(fs::exists(directory_ / "p/tasks"));
    EXPECT_FALSE(fs::exists(directory_ / "p/Makefile"));
}

TEST_F(Batch, WritesTheClimatologyOfItsFrames) {
    const ProgramResult columns = plan("p", {"--statistics"});
    ASSERT_EQ(columns.status, 0);
    EXPECT_THAT(columns.out, HasSubstr("; all counts take at most "));
    const auto count_bytes = [&](const std::string& how) {
        const ProgramResult made = plan("j" + how, {how, "--json"});
        return nlohmann::json::parse(made.out)["count_bytes"].get<std::int64_t>();
    };
    EXPECT_GT(count_bytes("--cell-statistics"), 2 * count_bytes("--statistics"));
    const std::string file = place("c.nc");
    const ProgramResult early = batch("statistics", "p", {"-o", file});
    EXPECT_EQ(early.status, 1) << "no frame is counted";
    EXPECT_FALSE(fs::exists(file));
    ASSERT_EQ(batch("submit", "p", {"--engine", "make"}).status, 0);
    for (const char* by : {"hour", "month", "all"}) {
        const ProgramResult made = batch("statistics", "p", {"--by", by, "-o", file, "--quiet"});
        EXPECT_EQ(made.status, 0) << made.err;
        EXPECT_EQ(static_cast<char>(read_file(file)->at(1)), 'H') << "netCDF-4 is HDF5";
    }
    ASSERT_EQ(plan("q").status, 0);
    EXPECT_EQ(batch("statistics", "q", {"-o", file}).status, 2) << "without --statistics";
    EXPECT_EQ(plan("r", {"--statistics", "--moment", "VEL"}).status, 2);
}

TEST_F(Batch, OwnGridsOfAStationNeedNoPlace) {
    const Words arguments =
        with({"batch", "plan", "--source", place("drop"), "-o", place("own")},
             words("--from 2005-08-22T02:50 --to 2005-08-22T03:05 --spacing-km 4"));
    ASSERT_EQ(run(arguments).status, 0);
    ASSERT_EQ(batch("submit", "own", {"--engine", "local"}).status, 0);
    EXPECT_EQ(grids_of(directory_ / "own/cache").size(), 3U)
        << "only volumes that begin in the range have grids";
    const ProgramResult refused = run(with(arguments, {"--center", "42,-76"}));
    EXPECT_EQ(refused.status, 2);
    EXPECT_THAT(refused.err, HasSubstr("need --mosaic NAME"));
    EXPECT_EQ(plan("own").status, 2) << "the directory has a plan already";
    const Words velocity = words("--moment VEL --dealias region --quality 0.5");
    const ProgramResult merged = run(with(arguments, velocity, {"--mosaic", "all"}));
    EXPECT_EQ(merged.status, 2);
    EXPECT_THAT(merged.err, HasSubstr("VELD is made for single stations"));
    Words weather = with(arguments, velocity);
    *(std::ranges::find(weather, "-o") + 1) = place("weather");
    ASSERT_EQ(run(weather).status, 0);
    ASSERT_EQ(batch("submit", "weather", {"--engine", "local"}).status, 0);
    const auto entries = *cache::StoreReader::open(directory_ / "weather/cache")
                              ->list("KBGM", level2::Moment::veld, std::nullopt, std::nullopt);
    ASSERT_EQ(entries.size(), 3U);
    EXPECT_THAT(cache::GridFile::open(entries[0].path)->description().provenance.notes,
                Contains(HasSubstr("probability of weather at least 0.5")));
}

// 2026-11-30: batch plan had no --storm-motion, so SRV always had the motion of the wind profile.
TEST_F(Batch, OwnGridsHaveTheGivenStormMotion) {
    const Words arguments =
        with({"batch", "plan", "--source", place("drop"), "-o", place("own")},
             words("--from 2005-08-22T02:50 --to 2005-08-22T02:56 --spacing-km 4"));
    const Words motion = {"--storm-motion", "270/20"};
    const ProgramResult refused = run(with(arguments, motion));
    EXPECT_EQ(refused.status, 2);
    EXPECT_THAT(refused.err, HasSubstr("--storm-motion needs --moment SRV"));
    ASSERT_EQ(run(with(arguments, {"--moment", "SRV"}, motion)).status, 0);
    ASSERT_EQ(batch("submit", "own", {"--engine", "local"}).status, 0);
    const auto entries = *cache::StoreReader::open(directory_ / "own/cache")
                              ->list("KBGM", level2::Moment::srv, std::nullopt, std::nullopt);
    ASSERT_FALSE(entries.empty());
    EXPECT_THAT(cache::GridFile::open(entries[0].path)->description().provenance.notes,
                Contains("storm motion 270/20, as given"));
    EXPECT_EQ(batch("check", "own", {}).status, 0);
}

}  // namespace
}  // namespace stormcellar::cli
