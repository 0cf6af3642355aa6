// Runs `stormcellar accuracy`, and `stormcellar grid` with options of effects, as a user does.
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/cli/run_stormcellar.h"
#include "tests/testing/data.h"
#include "tests/testing/file_bytes.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::cli {
namespace {

using testing::ProgramResult;

const Words small = {"--extent-km", "300,300", "--spacing-km", "5", "--threads", "1"};

TEST(Accuracy, BadUsageIsNamed) {
    EXPECT_EQ(run({"accuracy"}).status, 2);
    EXPECT_NE(run({"accuracy"}).err.find("--scene"), std::string::npos);
    EXPECT_EQ(run({"accuracy", "a", "b"}).status, 1);
    EXPECT_EQ(run({"accuracy", "nosuch"}).status, 1);
    EXPECT_EQ(run({"accuracy", "a", "--scene", "b"}).status, 2);
    const auto expect_refused = [](const Words& options, const std::string& part) {
        const ProgramResult ran = run(with({"accuracy", "a"}, options));
        EXPECT_EQ(ran.status, 2) << part;
        EXPECT_NE(ran.err.find(part), std::string::npos) << ran.err;
    };
    expect_refused({"--markdown", "--json"}, "cannot be used together");
    expect_refused({"--picture", "--held-out"}, "--picture takes one FILE");
    expect_refused({"--velocity", "--picture"}, "--velocity takes one FILE");
    expect_refused({"b", "--velocity"}, "--velocity takes one FILE");
    expect_refused({"--plot", "d.png"}, "must end in .svg");
    expect_refused({"--plot", ""}, "--plot: must not be empty");
    expect_refused({"--fields", "age"}, "--fields");
    expect_refused({"--time", "noon"}, "--time");
}

TEST(Accuracy, HelpSaysHowManyThreadsEachCommandTakes) {
    EXPECT_NE(run({"accuracy", "--help-all"}).out.find("Number of threads. Default: 1"),
              std::string::npos);
    EXPECT_NE(run({"grid", "--help-all"}).out.find("Number of threads. Default: all processors"),
              std::string::npos);
}

TEST(Accuracy, ErrorsNameTheFile) {
    STORMCELLAR_NEED_DATA();
    const std::string file = volume("KTLX19990503_235621.gz");
    const ProgramResult ran = run({"accuracy", file, "--moment", "ZDR"});
    EXPECT_EQ(ran.status, 1);
    EXPECT_EQ(ran.err, "stormcellar: " + file + ": the volume has no sweep with ZDR\n");
}

TEST(Accuracy, AGridWithoutValuesIsNoted) {
    STORMCELLAR_NEED_DATA();
    const ProgramResult ran = run(with(
        {"accuracy", volume("KTLX19990503_235621.gz"), "--rounds", "1", "--center", "0,0"}, small));
    EXPECT_EQ(ran.status, 0);
    EXPECT_NE(ran.err.find("note: none of the compared cells has a value"), std::string::npos)
        << ran.err;
}

Words lines_of(const std::string& text) {
    Words lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);)
        lines.push_back(line);
    return lines;
}

// The output has the head of each table of docs/accuracy.md, and rows of the same form.
TEST(Accuracy, MarkdownIsWhatThePageShows) {
    STORMCELLAR_NEED_DATA();
    const ProgramResult ran = run(with({"accuracy", volume("KTLX19990503_235621.gz"), "--rounds",
                                        "2", "--columns", "300", "--markdown"},
                                       small));
    ASSERT_EQ(ran.status, 0) << ran.err;
    const std::string text = testing::file_text(testing::source_directory() / "docs/accuracy.md");
    const auto head = ran.out.find("| step |");
    ASSERT_NE(head, std::string::npos) << ran.out;
    const auto printed = lines_of(ran.out.substr(head));
    ASSERT_EQ(printed.size(), 2U + 3 + 3 + 2 + 4 + 2 + 7) << ran.out;
    EXPECT_NE(text.find("\n" + printed[0] + "\n" + printed[1] + "\n"), std::string::npos);
    const std::string number = "[0-9.e+-]+";
    const std::regex row("\\| [a-z]+ \\| [^|]+ \\| " + number + " \\| " + number + " / " + number +
                         " \\| " + number + " / " + number + " / " + number + " / " + number +
                         " \\| [0-9]+\\.[0-9]{2} \\| (yes|no) \\|");
    for (std::size_t i = 2; i < printed.size(); ++i)
        EXPECT_TRUE(std::regex_match(printed[i], row)) << printed[i];
    std::size_t shown = 0;
    for (const std::string& line : lines_of(text))
        shown += std::regex_match(line, row) ? 1 : 0;
    EXPECT_GE(shown, 18U) << "rows of the table in docs/accuracy.md";
    EXPECT_NE(ran.out.find("| chain | exact | "), std::string::npos);
    EXPECT_NE(ran.out.find(" | 0 / 0 | 0 / 0 / 0 / 0 | 0.00 | yes |"), std::string::npos);
}

TEST(Accuracy, PrintsALadderForARealVolume) {
    STORMCELLAR_NEED_DATA();
    const testing::TemporaryDirectory directory;
    const std::string plot = (directory.path() / "plot.svg").string();
    const auto json = json_of(run(with({"accuracy", volume("KTLX19990503_235621.gz"), "--json",
                                        "--rounds", "1", "--columns", "300", "--plot", plot},
                                       small)));
    EXPECT_EQ(json["value_unit"], "dB");
    EXPECT_TRUE(json["truth"].empty());
    std::map<std::string, int> rungs;
    for (const auto& row : json["rows"]) {
        ++rungs[row["step"]];
        EXPECT_TRUE(row["time_s"].is_number());
        if (row["name"] == "exact") {
            EXPECT_EQ(row["value_max_db"].get<double>(), 0);
        }
        if (row["name"] == "nearest" && row["step"] == "chain") {
            EXPECT_GT(row["value_p99_db"].get<double>(), 1);
            EXPECT_GT(row["position_max_m"].get<double>(), 10)
                << "the cheapest chain leaves off refraction";
        }
    }
    EXPECT_EQ(rungs["frame"], 3);
    EXPECT_EQ(rungs["beam"], 3);
    EXPECT_EQ(rungs["interpolation"], 4);
    EXPECT_EQ(rungs["chain"], 7);
    std::ifstream svg(plot);
    std::stringstream text;
    text << svg.rdbuf();
    EXPECT_NE(text.str().find("</svg>"), std::string::npos);
}

// In each step, the exact choice (rung) has no error, and the cheapest rung has some.
TEST(Accuracy, PrintsALadderForAPictureWithItsLight) {
    STORMCELLAR_NEED_DATA();
    const ProgramResult ran = run(
        with({"accuracy", volume("KTLX19990503_235621.gz"), "--picture", "--rounds", "1", "--json"},
             small));
    const auto json = json_of(ran);
    std::map<std::string, std::vector<double>> steps;
    for (const auto& row : json["rows"]) {
        EXPECT_TRUE(row["time_s"].is_number());
        steps[row["step"]].push_back(row["image_p99_de"]);
    }
    ASSERT_EQ(steps.size(), 5U) << ran.out;
    EXPECT_EQ(steps["slices"].size(), 7U);
    EXPECT_EQ(steps["surface"].size(), 2U);
    EXPECT_EQ(steps["light"].size(), 3U);
    for (const auto& [step, errors] : steps)
        EXPECT_EQ(errors.back(), 0) << step;
    for (const char* step : {"slices", "integration", "surface", "light"})
        EXPECT_GT(steps[step].front(), 0.3) << step;
}

TEST(Accuracy, ComparesASceneWithItsTruth) {
    const testing::TemporaryDirectory directory;
    const std::string scene = (directory.path() / "scene.toml").string();
    std::ofstream(scene) << R"(
[radar]
station = "KTLX"
[volumes]
count = 1
interval_s = 500
start = "2024-06-01T22:00:00Z"
vcp = 35
[[storm]]
position_km = [50, 20]
core_km = 4
radii_km = [25, 25]
top_km = 12
peak_dbz = 50
)";
    const ProgramResult ran = run(
        with({"accuracy", "--scene", scene, "--json", "--rounds", "1", "--columns", "300"}, small));
    if (ran.status == 2) GTEST_FAIL() << ran.err;
    const auto json = json_of(ran);
    ASSERT_EQ(json["truth"].size(), 6U) << "one row for every chain except the traced chain";
    for (const auto& row : json["truth"]) {
        EXPECT_GT(row["count"].get<int>(), 50);
        EXPECT_LT(row["rms"].get<double>(), 12) << row["chain"];
    }
}

// With velocities folded at 12 m/s, each higher rung of dealiasing must get fewer gates wrong. At
// the real Nyquist velocity, dealiasing must remove jumps.
TEST(Accuracy, PrintsALadderOfDealiasing) {
    STORMCELLAR_NEED_DATA();
    const testing::TemporaryDirectory directory;
    const std::string plot = directory / "plot.svg";
    const auto json = json_of(run({"accuracy", "--velocity", volume("KTLX19990503_235621.gz"),
                                   "--rounds", "1", "--json", "--plot", plot}));
    EXPECT_NE(json["truth"].get<std::string>().find("favors anchored"), std::string::npos);
    std::map<std::string, nlohmann::json> real, at_12;
    for (const auto& row : json["rows"]) {
        EXPECT_GE(row["time_s"].get<double>(), 0);
        EXPECT_GT(row["gates"].get<int>(), 100'000);
        if (row["nyquist_mps"] == 12) at_12[row["name"]] = row;
        if (row["nyquist_mps"].get<double>() > 20) real[row["name"]] = row;
    }
    EXPECT_EQ(json["rows"].size(), 5U * 4);
    ASSERT_EQ(at_12.size(), 4U);
    EXPECT_GT(at_12["off"]["wrong"], 0.3);
    EXPECT_LT(at_12["profile"]["wrong"], at_12["off"]["wrong"]);
    EXPECT_LT(at_12["region"]["wrong"], at_12["profile"]["wrong"]);
    EXPECT_LT(at_12["anchored"]["wrong"], at_12["region"]["wrong"]);
    EXPECT_GT(at_12["anchored"]["ambiguous"], 0);
    EXPECT_LE(at_12["anchored"]["wrong_unmarked"], at_12["anchored"]["wrong"]);
    EXPECT_TRUE(at_12["anchored"]["pareto"].get<bool>());
    EXPECT_TRUE(at_12["off"]["jumps"].is_null());
    ASSERT_EQ(real.size(), 4U);
    EXPECT_TRUE(real["anchored"]["wrong"].is_null()) << "anchored itself is the truth";
    EXPECT_GT(real["off"]["jumps"], 10'000);
    EXPECT_LT(real["anchored"]["jumps"], 1'000);
    const std::string svg = testing::file_text(plot);
    EXPECT_NE(svg.find("Folded at 8.5 m/s, anchored gets "), std::string::npos) << svg;
}

TEST(Accuracy, ALadderOfDealiasingNeedsVelocities) {
    STORMCELLAR_NEED_DATA();
    const std::string tdwr = volume("Level2_TSTL_20220213_2357.ar2v");
    const ProgramResult ran = run({"accuracy", "--velocity", tdwr});
    EXPECT_EQ(ran.status, 1);
    EXPECT_NE(ran.err.find(tdwr + ": the velocities have no Nyquist velocity"), std::string::npos)
        << ran.err;
}

// A scene knows the true fold numbers, so dealiasing is scored at the real Nyquist velocity, too.
TEST(Accuracy, DealiasesASceneOfKnownWind) {
    const testing::TemporaryDirectory directory;
    const std::string scene = directory / "scene.toml";
    std::ofstream(scene) << R"(
[radar]
station = "KTLX"
[volumes]
count = 1
interval_s = 500
start = "2024-06-01T22:00:00Z"
[[cut]]
elevation_deg = 0.5
waveform = "doppler"
azimuth_rate_deg_s = 20
nyquist_mps = 18
[[wind.level]]
velocity_mps = [25, 20]
[instrument]
velocity_noise_mps = 1
velocity_folding = "on"
[[storm]]
position_km = [20, 20]
core_km = 4
radii_km = [90, 90]
top_km = 12
peak_dbz = 50
)";
    const ProgramResult ran =
        run({"accuracy", "--velocity", "--scene", scene, "--rounds", "1", "--json"});
    ASSERT_EQ(ran.status, 0) << ran.err;
    const auto json = json_of(ran);
    EXPECT_EQ(json["truth"], "that of the simulated scene");
    ASSERT_EQ(json["rows"].size(), 4U * 4) << "18, 16, 12 and 8.5 m/s";
    for (const auto& row : json["rows"]) {
        EXPECT_GT(row["known_gates"], 1'000);
        if (row["name"] == "off") {
            EXPECT_GT(row["wrong"], 0.05) << row;
        } else if (row["name"] == "anchored") {
            EXPECT_LT(row["wrong"], 0.001) << row;
        }
        EXPECT_EQ(row["wrong_unmarked"].is_null(), row["ambiguous"] == 1)
            << "without unmarked gates, the share of wrong ones is undefined: " << row;
    }
    const ProgramResult table =
        run({"accuracy", "--velocity", "--scene", scene, "--rounds", "1", "--markdown"});
    EXPECT_NE(table.out.find("simulated scene."), std::string::npos) << table.out;
    EXPECT_NE(table.out.find("| 8.5 | anchored | "), std::string::npos) << table.out;
}

class Effects : public ::testing::Test {
  protected:
    // Writes a sounding of two levels, the first at this height.
    [[nodiscard]] std::string sounding_from(int height_m) const {
        const fs::path path = directory_ / "own.csv";
        std::ofstream(path) << "height_m,refractivity\n"
                            << height_m << ",320\n"
                            << height_m + 1000 << ",270\n";
        return path;
    }

    const testing::TemporaryDirectory directory_;
    const std::string out_ = directory_ / "out.nc";
};

TEST_F(Effects, ATolerancePicksAndSaysWhatItPicked) {
    STORMCELLAR_NEED_DATA();
    const ProgramResult ran = run(with({"grid", volume("KTLX19990503_235621.gz"), "-o", out_,
                                        "--tolerance", "9 km, 20 dB", "--explain", "--json"},
                                       small));
    ASSERT_EQ(ran.status, 0) << ran.err;
    EXPECT_NE(ran.err.find("antenna_jitter"), std::string::npos)
        << "the explanation names this effect";
    const auto json = nlohmann::json::parse(ran.out);
    EXPECT_NE(json["predicted_error"].get<std::string>().find("dB"), std::string::npos);
    EXPECT_NE(json["effects"].get<std::string>().find("frame: "), std::string::npos);
    EXPECT_TRUE(fs::exists(out_));
}

TEST_F(Effects, ABudgetOutOfReachIsExit1AndWritesNothing) {
    STORMCELLAR_NEED_DATA();
    const ProgramResult ran = run(with({"grid", volume("KTLX19990503_235621.gz"), "-o", out_,
                                        "--tolerance", "1 m", "--effect", "refraction=off"},
                                       small));
    EXPECT_EQ(ran.status, 1);
    EXPECT_NE(ran.err.find("set off: refraction"), std::string::npos) << ran.err;
    EXPECT_FALSE(fs::exists(out_));
}

TEST_F(Effects, MisspeltOptionsAreNamed) {
    const auto expect_usage = [](const Words& options, const std::string& part) {
        const ProgramResult ran = run(with({"grid", "a", "-o", "b.nc"}, options));
        EXPECT_EQ(ran.status, 2) << part;
        EXPECT_NE(ran.err.find(part), std::string::npos) << ran.err;
    };
    expect_usage({"--method", "lineer"}, "eight-point");
    expect_usage({"--effect", "refractoin=on"}, "did you mean \"refraction\"");
    expect_usage({"--effect", "refraction=on", "--effect", "refraction=off"}, "refraction");
    expect_usage({"--tolerance", "5"}, "unit");
    expect_usage({"--tolerance", "1 dB", "--moment", "VEL"}, "m/s");
    expect_usage({"--tolerance", "dE 2"}, "colors");
    expect_usage({"--averaging", "Z", "--moment", "VEL"}, "REF");
    expect_usage({"--method", "linear", "--effect", "beam_width=on"},
                 "horizontal_interpolation, which is off (--method linear sets "
                 "column_interpolation on, horizontal_interpolation off, cell_size off)");
    expect_usage({"--method", "linear", "--effect", "beam_width=on", "--effect",
                  "horizontal_interpolation=off"},
                 "horizontal_interpolation, which is off\n");
}

// 2026-11-21: a sounding was read but not used.
TEST_F(Effects, AProfileOfOnesOwnTurnsRefractionOn) {
    STORMCELLAR_NEED_DATA();
    const std::string sounding = sounding_from(300);
    const auto gridded = [&](const Words& options) {
        return run(with({"grid", volume("KTLX19990503_235621.gz"), "-o", out_, "--json"},
                        with(small, options)));
    };
    const auto beam_of = [](const ProgramResult& ran) {
        return json_of(ran)["beam_model"].get<std::string>();
    };
    EXPECT_EQ(beam_of(gridded({})), "4/3 earth");
    EXPECT_EQ(beam_of(gridded({"--profile", "exponential"})), "4/3 earth")
        << "the exponential profile is the default";
    for (const auto& options : std::vector<std::vector<std::string>>{
             {}, {"--effect", "refraction=auto"}, {"--explain"}, {"--method", "nearest"}}) {
        const ProgramResult ran = gridded(with({"--profile", sounding}, options));
        EXPECT_NE(beam_of(ran).find("own.csv"), std::string::npos) << ran.out;
        EXPECT_EQ(ran.err.find("note"), std::string::npos) << ran.err;
    }
    EXPECT_NE(beam_of(gridded({"--profile", "standard"})).find("standard"), std::string::npos);
    const ProgramResult off = gridded({"--profile", sounding, "--effect", "refraction=off"});
    EXPECT_EQ(beam_of(off), "4/3 earth");
    EXPECT_NE(off.err.find("refraction is off"), std::string::npos) << off.err;
    EXPECT_EQ(std::count(off.err.begin(), off.err.end(), '\n'), 1) << off.err;
    const ProgramResult flat = gridded({"--profile", sounding, "--effect", "earth_curvature=off"});
    EXPECT_EQ(beam_of(flat), "flat earth");
    EXPECT_NE(flat.err.find("refraction is off"), std::string::npos) << flat.err;
    EXPECT_EQ(beam_of(gridded({"--profile", sounding, "--tolerance", "9 km, 20 dB"})), "4/3 earth")
        << "the planner leaves refraction off, because its effect is small enough";
}

TEST_F(Effects, ASoundingFarAboveTheAntennaIsNoted) {
    STORMCELLAR_NEED_DATA();
    const auto noted = [&](int height_m, const Words& command) {
        const ProgramResult ran = run(
            with(command, {volume("KTLX19990503_235621.gz"), "--profile", sounding_from(height_m)},
                 small));
        EXPECT_EQ(ran.status, 0) << ran.err;
        return ran.err;
    };
    const Words grid = {"grid", "-o", out_};
    const Words ladder = {"accuracy", "--rounds", "1", "--columns", "50"};
    const std::string note =
        "stormcellar: note: the sounding own.csv is extrapolated from its first level, at 900 m, "
        "down to the antenna, at 390 m above mean sea level\n";
    EXPECT_EQ(noted(900, grid), note);
    EXPECT_EQ(noted(900, ladder), note);
    EXPECT_EQ(noted(880, grid), "");
}

// 2026-11-21: some of these mistakes were reported as failed work, other mistakes as bad usage.
TEST_F(Effects, AProfileThatIsNoneIsBadUsage) {
    const auto written = [&](const std::string& name, const std::string& text) {
        const std::string path = (directory_.path() / name).string();
        std::ofstream(path) << text;
        return path;
    };
    for (const std::string& profile :
         {std::string{"exponental"}, written("empty.csv", ""), directory_.path().string(),
          written("head.csv", "height_m,refractivity\n"), written("words.csv", "no sounding\n"),
          written("large.csv", std::string(2 << 20, '#'))}) {
        const ProgramResult ran = run({"grid", "a", "-o", "b.nc", "--profile", profile});
        EXPECT_EQ(ran.status, 2) << profile;
        EXPECT_NE(ran.err.find("--profile takes exponential, standard or a sounding file: "),
                  std::string::npos)
            << ran.err;
        EXPECT_NE(ran.err.find(profile), std::string::npos) << ran.err;
    }
}

TEST_F(Effects, EveryMethodMakesAGridThatNamesIt) {
    STORMCELLAR_NEED_DATA();
    const std::vector<std::pair<std::string, std::string>> methods = {
        {"nearest", "column-nearest"},
        {"linear", "column-linear"},
        {"eight-point", "eight-point"},
        {"beam-weighted", "beam-weighted"},
        {"area", "area, beam-weighted"}};
    for (const auto& [option, name] : methods) {
        const auto json = json_of(run(with(
            {"grid", volume("KTLX19990503_235621.gz"), "-o", out_, "--method", option, "--json"},
            small)));
        EXPECT_EQ(json["method"], name);
        EXPECT_GT(json["cells"]["value"].get<int>(), 100);
        EXPECT_NE(json["predicted_error"].get<std::string>().find("values not predicted"),
                  std::string::npos);
    }
}

}  // namespace
}  // namespace stormcellar::cli
