// Runs `stormcellar grid` for several files as a user does, and compares frames with volumes that
// were held out.
#include <filesystem>
#include <map>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/cli/run_stormcellar.h"
#include "tests/testing/data.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::cli {
namespace {

using testing::ProgramResult;

std::string real(const std::string& name) {
    return testing::real_file(name);
}

class Mosaic : public ::testing::Test {
  protected:
    void SetUp() override { STORMCELLAR_NEED_DATA(); }
    nlohmann::json grid(Words files, const Words& options) {
        files.insert(files.begin(), "grid");
        files.insert(files.end(), {"--spacing-km", "8", "--levels-km", "1,3,6", "--json", "-o",
                                   (directory_ / "out.nc").string()});
        files.insert(files.end(), options.begin(), options.end());
        return json_of(run(files));
    }
    testing::TemporaryDirectory directory_;
};

const std::string bgm = "mosaic-northeast/KBGM20100911_012056_V03.gz";
const std::string enx = "mosaic-northeast/KENX20100911_011108_V03.gz";

TEST_F(Mosaic, HoldsAllSitesInAnyOrder) {
    const auto one = grid({real(bgm), real(enx)}, {});
    const auto other = grid({real(enx), real(bgm)}, {"--threads", "1"});
    EXPECT_EQ(one["stations"], (Words{"KBGM", "KENX"}));
    EXPECT_EQ(one["cells"], other["cells"]);
    EXPECT_EQ(one["time"], other["time"]);
    EXPECT_GT(one["cells"]["value"], 1000);
    // Two sites leave fewer cells unseen than one site does on the same columns.
    const Words same_columns = {"--center", "42.5,-75", "--extent-km", "640,640"};
    const auto both = grid({real(bgm), real(enx)}, same_columns);
    const auto alone = grid({real(bgm)}, same_columns);
    EXPECT_LT(both["cells"]["not_seen"], alone["cells"]["not_seen"]);
}

TEST_F(Mosaic, CountsAndWeightsAreWrittenOnDemand) {
    EXPECT_EQ(grid({real(bgm), real(enx)}, {})["fields"].size(), 0U);
    EXPECT_EQ(grid({real(bgm), real(enx)}, {"--fields", "counts,weights"})["fields"],
              (Words{"counts", "weights"}));
    EXPECT_EQ(grid({real(bgm), real(enx)}, {"--fields", "all"})["fields"].size(), 2U);
    EXPECT_EQ(grid({real(bgm), real(enx)}, {"--fields", "weights"})["fields"], Words{"weights"});
}

TEST_F(Mosaic, OfASiteWithNoVolumeNearTheTimeSaysSo) {
    const auto made = grid({real(bgm), real(enx)}, {"--time", "2010-09-11T01:37:00Z"});
    EXPECT_EQ(made["stations"], (Words{"KBGM"}));
    EXPECT_NE(made["notes"].dump().find("is more than 15 minutes from 2010-09-11T01:37:00Z"),
              std::string::npos);
    const ProgramResult none = run({"grid", real(bgm), real(enx), "--time", "2011-01-01T00:00:00Z",
                                    "-o", (directory_ / "none.nc").string()});
    EXPECT_EQ(none.status, 1);
    EXPECT_NE(none.err.find("no site has a volume"), std::string::npos) << none.err;
}

TEST_F(Mosaic, AToleranceChoosesOfTimeOverlapAndCodesToo) {
    const auto effects_by = [&](const std::string& tolerance) {
        const auto made =
            json_of(run({"grid", real("sequence-kbgm/KBGM20050822_024414.gz"),
                         real("sequence-kbgm/KBGM20050822_025001.gz"), "--time",
                         "2005-08-22T02:50:00Z", "--spacing-km", "3", "--tolerance", tolerance,
                         "--json", "-o", (directory_ / "out.nc").string()}));
        EXPECT_NE(made["predicted_error"].dump().find("(99th percentile)"), std::string::npos);
        return made["effects"].get<std::string>();
    };
    const std::string close = effects_by("1 km, 8 dB");
    EXPECT_NE(close.find("time: advected"), std::string::npos) << close;
    EXPECT_NE(close.find("codes: default steps"), std::string::npos) << close;
    const std::string fine = effects_by("100 m, 0.1 dB");
    EXPECT_NE(fine.find("codes: fine steps"), std::string::npos) << fine;
    const std::string loose = effects_by("30 km, 90 dB");
    EXPECT_NE(loose.find("time: nearest"), std::string::npos) << loose;
}

TEST_F(Mosaic, ExplainsEveryEffectOfItsOwn) {
    const ProgramResult ran = run({"grid", real(bgm), real(enx), "--spacing-km", "8", "--levels-km",
                                   "1,3", "--explain", "-o", (directory_ / "out.nc").string()});
    EXPECT_EQ(ran.status, 0) << ran.err;
    for (const char* effect :
         {"time_blend", "echo_motion", "sweep_times", "site_overlap", "fine_codes"})
        EXPECT_NE(ran.out.find(effect), std::string::npos) << effect;
    const ProgramResult velocity = run({"grid", real(bgm), real(enx), "--moment", "VEL",
                                        "--explain", "-o", (directory_ / "vel.nc").string()});
    EXPECT_EQ(velocity.status, 2) << velocity.err;
    EXPECT_NE(velocity.err.find("a plan cannot be made for VEL"), std::string::npos)
        << velocity.err;
    const ProgramResult wrong =
        run({"grid", real(bgm), real(enx), "--time-method", "advected", "--effect",
             "time_blend=off", "-o", (directory_ / "out.nc").string()});
    EXPECT_EQ(wrong.status, 2) << wrong.err;
    EXPECT_NE(wrong.err.find("--time-method advected"), std::string::npos) << wrong.err;
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

TEST_F(Mosaic, ALadderShowsWhatAFrameCosts) {
    const std::string plot = (directory_ / "plot.svg").string();
    const ProgramResult ran =
        run({"accuracy", real("sequence-kbgm/KBGM20050822_024414.gz"),
             real("sequence-kbgm/KBGM20050822_025001.gz"), "--time", "2005-08-22T02:50:00Z",
             "--spacing-km", "4", "--rounds", "1", "--plot", plot, "--json"});
    ASSERT_EQ(ran.status, 0) << ran.err;
    EXPECT_TRUE(fs::exists(plot));
    const auto ladder = nlohmann::json::parse(ran.out);
    std::map<std::string, std::vector<nlohmann::json>> steps;
    for (const auto& row : ladder["rows"])
        steps[row["step"]].push_back(row);
    ASSERT_EQ(steps["time"].size(), 3U);
    ASSERT_EQ(steps["sweeps"].size(), 2U);
    ASSERT_EQ(steps["codes"].size(), 2U);
    for (const auto& [step, rows] : steps) {
        EXPECT_EQ(rows.back()["value_p99_db"], 0) << step;
        // With one site, both rules of overlap give the same result, so only the faster rule is on
        // the Pareto front.
        EXPECT_TRUE(step == "overlap" || rows.back()["pareto"]) << step;
    }
    EXPECT_GT(steps["time"][0]["value_rms_db"], steps["time"][1]["value_rms_db"]);
    EXPECT_GT(steps["time"][0]["position_max_m"], 1000);
    EXPECT_GT(steps["sweeps"][0]["value_p99_db"], 1);
    // A value is rounded to 0.5 dB twice. Each rounding adds at most 0.25 dB, and the fine codes
    // add a little.
    EXPECT_GT(steps["codes"][0]["value_p99_db"], 0.2);
    EXPECT_LE(steps["codes"][0]["value_max_db"], 0.51);
}

TEST_F(Mosaic, ToHoldOutTakesAFileOfThreeRepeatsOrThreeFiles) {
    const ProgramResult two = run({"accuracy", real(bgm), real(bgm)});
    EXPECT_EQ(two.status, 2);
    EXPECT_NE(two.err.find("at least 3 of them"), std::string::npos) << two.err;
    const ProgramResult once = run({"accuracy", "--held-out", real(bgm)});
    EXPECT_EQ(once.status, 1);
    EXPECT_NE(once.err.find("there must be at least three"), std::string::npos) << once.err;
}

}  // namespace
}  // namespace stormcellar::cli
