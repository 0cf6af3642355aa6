// Tests the scripts that are written for Slurm and make.
#include "batch/engines.h"

#include <cstdlib>
#include <fstream>
#include <numeric>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/batch/small_archive.h"

namespace stormcellar::batch {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

// A plan with ten stations on two days in tasks 0 to 19, and mosaics (frames) from 22:00 to 02:00
// in tasks 20 to 23.
class BatchEngines : public ::testing::Test {
  protected:
    void SetUp() override {
        const Recipe recipe = recipe_between("2013-05-20T22:00Z", "2013-05-21T01:59Z");
        std::vector<StationDay> days;
        for (const char* date : {"2013-05-20", "2013-05-21"}) {
            for (const char* station :
                 {"KAMA", "KDDC", "KDYX", "KFDR", "KFWS", "KICT", "KINX", "KLBB", "KTLX", "KVNX"}) {
                days.push_back({std::chrono::floor<std::chrono::days>(at(date)),
                                station,
                                {"."},
                                7,
                                3'500'000'000});
            }
        }
        ASSERT_TRUE(write_plan(place_, recipe, days));
        plan_.emplace(*Plan::open(place_));
        ASSERT_EQ(plan_->facts().tasks(), 24U);
    }
    [[nodiscard]] std::vector<SlurmJob> jobs(const std::vector<std::size_t>& missing,
                                             const EngineOptions& options = {}) const {
        return slurm_jobs(*plan_, lists_of(*plan_, missing), options);
    }
    static std::vector<std::size_t> numbers(std::size_t count) {
        std::vector<std::size_t> all(count);
        std::iota(all.begin(), all.end(), std::size_t{0});
        return all;
    }

    testing::TemporaryDirectory directory_;
    fs::path place_ = directory_ / "it's a $plan \\#1";
    std::optional<Plan> plan_;
};

TEST_F(BatchEngines, SlurmHasAnArrayOfGridsAndOneOfFrames) {
    const auto all = jobs(numbers(24), {.program = "/opt/stormcellar", .jobs = 4});
    ASSERT_THAT(all, SizeIs(2));
    EXPECT_EQ(all[0].name, "grids");
    EXPECT_THAT(all[0].text, HasSubstr("#SBATCH --array=0-19%4\n"));
    // The limit in minutes is four times the estimated 100 s, plus five minutes.
    EXPECT_THAT(all[0].text, HasSubstr("#SBATCH --time=12\n"));
    EXPECT_THAT(all[0].text, HasSubstr("first=$((0 + SLURM_ARRAY_TASK_ID * 1))\n"));
    EXPECT_THAT(all[0].text, HasSubstr("((last < 20)) || last=19\n"));
    EXPECT_THAT(all[0].text, HasSubstr("exec '/opt/stormcellar' batch run --plan "));
    EXPECT_THAT(all[0].text, HasSubstr("/it'\\''s a $plan \\#1' --task"));
    EXPECT_EQ(all[1].name, "frames");
    EXPECT_THAT(all[1].text, HasSubstr("#SBATCH --array=0-3%4\n"));
    EXPECT_THAT(all[1].text, HasSubstr("first=$((20 + SLURM_ARRAY_TASK_ID * 1))\n"));
    EXPECT_THAT(all[1].text, HasSubstr("batch merge"));
}

TEST_F(BatchEngines, OnlyWhatIsMissingIsSubmitted) {
    const auto some = jobs({0, 2, 3, 4, 19});
    ASSERT_THAT(some, SizeIs(1));
    EXPECT_THAT(some[0].text, HasSubstr("#SBATCH --array=0,2-4,19\n"));
    EXPECT_THAT(jobs({}), IsEmpty());
}

// If an array may have 7 elements, each gets three of the 20 tasks, and the last element gets two.
TEST_F(BatchEngines, AnArrayHasNoMoreElementsThanSlurmTakes) {
    const auto all = jobs(numbers(20), {.array_size = 7});
    EXPECT_THAT(all.at(0).text, HasSubstr("#SBATCH --array=0-6\n"));
    EXPECT_THAT(all.at(0).text, HasSubstr("first=$((0 + SLURM_ARRAY_TASK_ID * 3))\n"));
    EXPECT_THAT(all.at(0).text, HasSubstr("last=$((first + 2))\n"));
    EXPECT_THAT(all.at(0).text, HasSubstr("#SBATCH --time=25\n"));
    EXPECT_THAT(jobs({5, 18}, {.array_size = 7}).at(0).text, HasSubstr("#SBATCH --array=1,6\n"));
}

TEST_F(BatchEngines, MakeKnowsWhichGridsTheFramesNeed) {
    const auto text =
        makefile_of(*plan_, lists_of(*plan_, {1, 2, 12, 20, 22, 23}), {.program = "stormcellar"});
    ASSERT_TRUE(text);
    EXPECT_THAT(*text, HasSubstr("GRIDS = grid-1 grid-2 grid-12\n"));
    EXPECT_THAT(*text, HasSubstr("/it'\\''s a $$plan \\\\\\#1' --threads 1 --task\n"));
    // Frames from 22:00 to 22:59 need one day; the hour after midnight needs both days.
    EXPECT_THAT(*text, HasSubstr("frame-20: needs-0-10\n"));
    EXPECT_THAT(*text, HasSubstr("needs-0-10: grid-1 grid-2\n"));
    EXPECT_THAT(*text, HasSubstr("frame-22: needs-0-20\n"));
    EXPECT_THAT(*text, HasSubstr("needs-0-20: grid-1 grid-2 grid-12\n"));
    EXPECT_THAT(*text, HasSubstr("frame-23: needs-10-20\nneeds-10-20: grid-12\n"));
}

// 2026-11-28: make took a # in a plan's path for the start of a comment. A line feed in the path or
// in --partition ended a comment of the script, so the rest of the text ran as a command.
TEST_F(BatchEngines, MakeReadsThePathOfThePlanBack) {
    const auto text = makefile_of(*plan_, lists_of(*plan_, {1}), {.program = "/bin/echo"});
    ASSERT_TRUE(text);
    const auto makefile = directory_ / "Makefile";
    std::ofstream(makefile) << *text;
    const std::string command = "make -s -f " + quoted(makefile.native()) + " grid-1 > " +
                                quoted((directory_ / "said").native());
    ASSERT_EQ(std::system(command.c_str()), 0);
    std::string said;
    std::getline(std::ifstream(directory_ / "said"), said);
    EXPECT_EQ(said, "batch run --plan " + place_.native() + " --threads 1 --task 1");
}

TEST_F(BatchEngines, NamesThatEndALineAreRefused) {
    EXPECT_TRUE(check_names(*plan_, {.partition = "day_long-2"}));
    for (const char* partition : {"a\ntouch pwned", "a b", "$(x)", "a;b"})
        EXPECT_FALSE(check_names(*plan_, {.partition = partition})) << partition;
    EXPECT_FALSE(check_names(*plan_, {.program = "/bin/x\ntouch pwned"}));
    Recipe recipe;
    recipe.source = "/archive";
    recipe.cache = "/share/cache";
    recipe.from = recipe.to = at("2013-05-20T22:00Z");
    const std::vector<StationDay> days{
        {std::chrono::floor<std::chrono::days>(recipe.from), "KTLX", {"."}, 1, 1}};
    for (const char* name : {"x\ntouch pwned #", "d\xEFx"}) {
        const Status written = write_plan(directory_ / name, recipe, days);
        ASSERT_FALSE(written);
        EXPECT_EQ(written.error().code, ErrorCode::bad_argument);
    }
}

}  // namespace
}  // namespace stormcellar::batch
