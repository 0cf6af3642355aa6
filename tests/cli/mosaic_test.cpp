// The program itself, as a user runs it: `stormcellar grid` of several files, and frames scored on
// volumes held out.
#include <filesystem>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/testing/data.h"
#include "tests/testing/program.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::cli {
namespace {

using testing::ProgramResult;

ProgramResult run(const std::vector<std::string>& arguments) {
    return testing::run_program(STORMCELLAR_PROGRAM, arguments);
}

std::string real(const std::string& name) {
    return (*testing::data_directory() / name).string();
}

class Mosaic : public ::testing::Test {
  protected:
    void SetUp() override { STORMCELLAR_NEED_DATA(); }
    nlohmann::json grid(std::vector<std::string> files, const std::vector<std::string>& options) {
        files.insert(files.begin(), "grid");
        files.insert(files.end(), {"--spacing-km", "8", "--levels-km", "1,3,6", "--json", "-o",
                                   (directory_ / "out.nc").string()});
        files.insert(files.end(), options.begin(), options.end());
        const ProgramResult ran = run(files);
        EXPECT_EQ(ran.status, 0) << ran.err;
        return ran.status == 0 ? nlohmann::json::parse(ran.out) : nlohmann::json::object();
    }
    testing::TemporaryDirectory directory_;
};

const std::string bgm = "mosaic-northeast/KBGM20100911_012056_V03.gz";
const std::string enx = "mosaic-northeast/KENX20100911_011108_V03.gz";

TEST_F(Mosaic, HoldsAllSitesInAnyOrder) {
    const auto one = grid({real(bgm), real(enx)}, {});
    const auto other = grid({real(enx), real(bgm)}, {"--threads", "1"});
    EXPECT_EQ(one["stations"], (std::vector<std::string>{"KBGM", "KENX"}));
    EXPECT_EQ(one["cells"], other["cells"]);
    EXPECT_EQ(one["time"], other["time"]);
    EXPECT_GT(one["cells"]["value"], 1000);
    // Each sees what it sees alone, on the same columns.
    const std::vector<std::string> same_columns = {"--center", "42.5,-75", "--extent-km",
                                                   "640,640"};
    const auto both = grid({real(bgm), real(enx)}, same_columns);
    const auto alone = grid({real(bgm)}, same_columns);
    EXPECT_LT(both["cells"]["not_seen"], alone["cells"]["not_seen"]);
}

TEST_F(Mosaic, CountsAndWeightsAreWrittenOnDemand) {
    EXPECT_EQ(grid({real(bgm), real(enx)}, {})["fields"].size(), 0U);
    EXPECT_EQ(grid({real(bgm), real(enx)}, {"--fields", "counts,weights"})["fields"],
              (std::vector<std::string>{"counts", "weights"}));
    EXPECT_EQ(grid({real(bgm), real(enx)}, {"--fields", "all"})["fields"].size(), 2U);
    EXPECT_EQ(grid({real(bgm), real(enx)}, {"--fields", "weights"})["fields"],
              std::vector<std::string>{"weights"});
}

TEST_F(Mosaic, OfASiteWithNoVolumeNearTheTimeSaysSo) {
    const auto made = grid({real(bgm), real(enx)}, {"--time", "2010-09-11T01:37:00Z"});
    EXPECT_EQ(made["stations"], (std::vector<std::string>{"KBGM"}));
    EXPECT_NE(made["notes"].dump().find("KENX: no volume within 15 minutes"), std::string::npos);
    const ProgramResult none = run({"grid", real(bgm), real(enx), "--time", "2011-01-01T00:00:00Z",
                                    "-o", (directory_ / "none.nc").string()});
    EXPECT_EQ(none.status, 1);
    EXPECT_NE(none.err.find("no site has a volume"), std::string::npos) << none.err;
}

TEST_F(Mosaic, VolumesHeldOutAreMadeAgainBestByAdvection) {
    const ProgramResult ran =
        run({"accuracy", real("sequence-kbgm/KBGM20050822_024414.gz"),
             real("sequence-kbgm/KBGM20050822_025549.gz"),
             real("sequence-kbgm/KBGM20050822_025001.gz"), "--spacing-km", "2", "--json"});
    ASSERT_EQ(ran.status, 0) << ran.err;
    const auto rows = nlohmann::json::parse(ran.out)["rows"];
    ASSERT_EQ(rows.size(), 3U);
    EXPECT_EQ(rows[0]["held_out"], "KBGM20050822_025001.gz");
    EXPECT_EQ(rows[2]["method"], "advected");
    EXPECT_LT(rows[2]["rms"], 0.8 * rows[1]["rms"].get<double>());
    EXPECT_LT(rows[1]["rms"], rows[0]["rms"]);
    EXPECT_LT(rows[2]["echo_missed"], 0.5 * rows[1]["echo_missed"].get<double>());
}

TEST_F(Mosaic, ToHoldOutTakesAFileOfThreeRepeatsOrThreeFiles) {
    EXPECT_EQ(run({"accuracy", real(bgm), real(enx)}).status, 2);
    const ProgramResult mixed = run({"accuracy", real(bgm), real(enx), real(bgm)});
    EXPECT_EQ(mixed.status, 2);
    EXPECT_NE(mixed.err.find("this takes one site's"), std::string::npos) << mixed.err;
    const ProgramResult once = run({"accuracy", "--held-out", real(bgm)});
    EXPECT_EQ(once.status, 1);
    EXPECT_NE(once.err.find("takes three"), std::string::npos) << once.err;
}

}  // namespace
}  // namespace stormcellar::cli
