// Runs `stormcellar synth` and `replay` as a user does.
#include <csignal>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/cli/run_stormcellar.h"
#include "tests/testing/data.h"
#include "tests/testing/file_bytes.h"
#include "tests/testing/temporary_directory.h"
#include "tests/testing/waiting.h"

namespace stormcellar::cli {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr const char* first_volume = "XSYN20240601_220000_V06";
constexpr const char* second_volume = "XSYN20240601_220100_V06";

class Synth : public ::testing::Test {
  protected:
    static std::string scene() {
        return (testing::source_directory() / "scenes/small-storm.toml").string();
    }
    [[nodiscard]] std::string at(const std::string& name) const {
        return (directory_ / name).string();
    }
    void synthesise() const {
        const auto result = run({"synth", scene(), "-o", at("volumes")});
        ASSERT_EQ(result.status, 0) << result.err;
    }
    testing::TemporaryDirectory directory_;
};

Words names_in(const fs::path& directory) {
    Words names;
    for (const auto& entry : fs::directory_iterator(directory))
        names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
}

TEST_F(Synth, WritesVolumesThatInfoReads) {
    const auto written = run({"synth", scene(), "-o", at("volumes")});
    ASSERT_EQ(written.status, 0) << written.err;
    EXPECT_EQ(written.out,
              at("volumes/") + first_volume + "\n" + at("volumes/") + second_volume + "\n");
    const auto volume = json_of(run({"info", at("volumes/") + second_volume, "--json"}));
    EXPECT_EQ(volume["site"], "XSYN");
    EXPECT_EQ(volume["n_sweeps"], 3);
    EXPECT_EQ(volume["sweeps"][0]["n_radials"], 360);
    EXPECT_TRUE(volume["corruption"].is_null());
    EXPECT_GT(volume["sweeps"][0]["moments"]["REF"]["valid"], 1000);
}

TEST_F(Synth, SaysWhatItDidAsJson) {
    const auto report =
        json_of(run({"synth", scene(), "-o", at("volumes"), "--threads", "2", "--json"}));
    ASSERT_EQ(report["files"].size(), 2U);
    std::uintmax_t bytes = 0;
    for (const std::string file : report["files"])
        bytes += fs::file_size(file);
    EXPECT_EQ(report["bytes"], bytes);
}

TEST_F(Synth, MistakesAreNamed) {
    std::ofstream(at("bad.toml")) << "[radar]\nstation = \"KTLX\"\n[volumes]\ncount = 0\n"
                                  << "start = \"2024-06-01\"\nvcp = 212\n";
    const auto bad = run({"synth", at("bad.toml"), "-o", at("volumes")});
    EXPECT_EQ(bad.status, 2);
    EXPECT_THAT(bad.err, HasSubstr("bad.toml:4: [volumes] count: 0 is out of range"));
    const auto missing = run({"synth", at("none.toml"), "-o", at("volumes")});
    EXPECT_EQ(missing.status, 1);
    EXPECT_THAT(missing.err, HasSubstr("none.toml"));
    EXPECT_EQ(run({"synth", scene()}).status, 2) << "the directory is missing";
    EXPECT_FALSE(fs::exists(at("volumes")));
}

TEST_F(Synth, InterruptedKeepsWholeVolumesAndEndsByTheSignal) {
    std::string toml = testing::file_text(scene());
    toml.replace(toml.find("count = 2"), 9, "count = 9000");
    std::ofstream(at("long.toml")) << toml;
    const fs::path volumes = at("volumes");
    const int signal = testing::interrupt_program(
        STORMCELLAR_PROGRAM, {"synth", at("long.toml"), "-o", volumes, "--json"}, [&volumes] {
            return fs::exists(volumes / first_volume) && fs::exists(volumes / second_volume);
        });
    EXPECT_EQ(signal, SIGINT);
    const auto names = names_in(volumes);
    ASSERT_GE(names.size(), 2U);
    EXPECT_LT(names.size(), 9000U);
    for (const std::string& name : names) {
        EXPECT_EQ(run({"info", volumes / name}).status, 0) << name;
    }
}

TEST_F(Synth, ReplayDeliversTheVolumes) {
    synthesise();
    fs::create_directory(at("drop"));
    const auto result =
        run({"replay", at("volumes"), at("drop"), "--as", "growing", "--interval", "0", "--json"});
    EXPECT_EQ(json_of(result)["files"], 2);
    EXPECT_EQ(nlohmann::json::parse(result.out)["interrupted"], false);
    EXPECT_THAT(result.err, HasSubstr("stormcellar: 2 files of 2024-06-01T22:00:00Z to "
                                      "2024-06-01T22:01:00Z; the replay takes no time\n"));
    EXPECT_THAT(names_in(at("drop")), ElementsAre(first_volume, second_volume));
    for (const char* name : {first_volume, second_volume}) {
        EXPECT_EQ(fs::file_size(at("drop/") + name), fs::file_size(at("volumes/") + name));
    }
    const auto again = run({"replay", at("volumes"), at("drop"), "--interval", "0"});
    EXPECT_EQ(again.status, 1);
    EXPECT_THAT(again.err, HasSubstr("exists already; nothing was replayed"));
}

TEST_F(Synth, ReplayMakesChunksWithFaultsAndNamesEachOne) {
    synthesise();
    const auto play = [this](const std::string& drop) {
        fs::create_directory(at(drop));
        return run({"replay", at("volumes"), at(drop), "--as", "chunks", "--speed", "1000000",
                    "--faults", "drop=0.3,truncate=0.3,seed=3", "--json"});
    };
    const auto report = json_of(play("drop"));
    ASSERT_FALSE(report["faults"].empty());
    std::size_t dropped = 0;
    for (const auto& made : report["faults"]) {
        const fs::path chunk = at("drop/") + made["file"].get<std::string>();
        if (made["fault"] == "drop") {
            EXPECT_FALSE(fs::exists(chunk));
            ++dropped;
        } else {
            EXPECT_EQ(made["fault"], "truncate");
            EXPECT_EQ(fs::file_size(chunk), made["kept_bytes"].get<std::uint64_t>());
            EXPECT_LT(made["kept_bytes"], made["bytes"]);
        }
        EXPECT_GE(made["chunk"], 1);
        EXPECT_TRUE(fs::exists(made["source"].get<std::string>()));
    }
    EXPECT_GT(dropped, 0U);
    const auto again = nlohmann::json::parse(play("second").out);
    EXPECT_EQ(again["faults"], report["faults"]) << "the same seed gives the same faults";
    fs::create_directory(at("text"));
    const auto text = run({"replay", at("volumes"), at("text"), "--interval", "0", "--as",
                           "growing", "--faults", "repeat=1"});
    EXPECT_EQ(text.status, 0);
    EXPECT_THAT(text.err, HasSubstr("\nrepeat: "));
}

TEST_F(Synth, ReplayNamesMistakes) {
    synthesise();
    const auto missing = run({"replay", at("volumes"), at("none")});
    EXPECT_EQ(missing.status, 1);
    EXPECT_THAT(missing.err, HasSubstr("none: there is no such directory"));
    const std::string drop = directory_.path();
    EXPECT_EQ(run({"replay", drop}).status, 2);
    EXPECT_EQ(run({"replay", at("volumes"), drop, "--as", "torn"}).status, 2);
    EXPECT_EQ(run({"replay", at("volumes"), drop, "--interval", "-1"}).status, 2);
    EXPECT_EQ(run({"replay", at("volumes"), drop, "--interval", "1", "--speed", "2"}).status, 2);
    const auto faults = run({"replay", at("volumes"), drop, "--faults", "lose=1"});
    EXPECT_EQ(faults.status, 2);
    EXPECT_THAT(faults.err, HasSubstr("faults: there is no fault 'lose'"));
}

// 2026-11-22: a replay did not say how long it would take or wait, and an interrupted replay
// printed no JSON.
TEST_F(Synth, AReplayThatWaitsSaysSoAndAnInterruptedOneWhatWasDone) {
    synthesise();
    fs::create_directory(at("drop"));
    testing::RunningProgram replay(
        STORMCELLAR_PROGRAM, {"replay", at("volumes"), at("drop"), "--interval", "3600", "--json"});
    ASSERT_TRUE(
        testing::eventually([&] { return replay.err().find("waiting") != std::string::npos; }));
    EXPECT_EQ(replay.end(SIGINT), -SIGINT);
    EXPECT_THAT(replay.err(),
                HasSubstr("stormcellar: 2 files of 2024-06-01T22:00:00Z to 2024-06-01T22:01:00Z; "
                          "the replay takes 60 min (--speed N makes it faster; --interval S "));
    EXPECT_THAT(replay.err(), HasSubstr("stormcellar: waiting 60 min for " + at("volumes/") +
                                        second_volume + "\n"));
    EXPECT_THAT(replay.err(), HasSubstr("stormcellar: interrupted after 1 of 2 files\n"));
    const auto report = nlohmann::json::parse(replay.out());
    EXPECT_EQ(report["interrupted"], true);
    EXPECT_EQ(report["files"], 1);
    EXPECT_EQ(report["unfinished"], nlohmann::json::array());
}

TEST_F(Synth, AnInterruptedReplayNamesTheUnfinishedFile) {
    synthesise();
    fs::create_directory(at("drop"));
    const fs::path growing = at("drop/") + std::string(first_volume);
    const int signal = testing::interrupt_program(
        STORMCELLAR_PROGRAM,
        {"replay", at("volumes"), at("drop"), "--as", "growing", "--interval", "3600"},
        [&growing] { return fs::exists(growing); });
    EXPECT_EQ(signal, SIGINT);
    EXPECT_THAT(names_in(at("drop")), ElementsAre(first_volume));
    EXPECT_LT(fs::file_size(growing), fs::file_size(at("volumes/") + first_volume));
}

}  // namespace
}  // namespace stormcellar::cli
