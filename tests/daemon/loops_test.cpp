// Runs the real stormcellard with loops of the real stormcellar.
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "tests/daemon/running_daemon.h"
#include "tests/daemon/write_file.h"
#include "tests/testing/program.h"
#include "tests/testing/small_sequence.h"
#include "tests/testing/temporary_directory.h"
#include "tests/testing/waiting.h"

namespace stormcellar::daemon {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const std::map<std::string, std::string>& with_program() {
    static const std::map<std::string, std::string> path{
        {"PATH", fs::path(STORMCELLAR_PROGRAM).parent_path().native() + ":/usr/bin:/bin"}};
    return path;
}

constexpr const char* one_loop =
    "[ingest]\nquiet_seconds = 2\n"
    "[[loop]]\nname = \"binghamton\"\nscene = \"scene.toml\"\ndomain = \"KBGM\"\nlast = 2\n"
    "outputs = [\"loops/kbgm.webp\"]\n";

class Loops : public ::testing::Test {
  protected:
    void SetUp() override {
        fs::create_directory(daemon_.root() / "loops");
        daemon_.write_scene();
    }
    void drop(const std::string& name) { testing::write_small_volume(name, daemon_.drop() / name); }
    // Returns the process of the loop that was started last.
    pid_t process() const {
        const std::string log = daemon_.log();
        const std::string before = "started as process ";
        const std::size_t at = log.rfind(before);
        return at == std::string::npos ? 0 : std::stoi(log.substr(at + before.size()));
    }
    static bool is_gone(pid_t process) {
        std::ifstream stat("/proc/" + std::to_string(process) + "/stat");
        std::string text;
        std::getline(stat, text);
        const std::size_t name_end = text.rfind(')');
        return name_end == std::string::npos || text.substr(name_end + 2, 1) == "Z";
    }
    [[nodiscard]] fs::path output() const { return daemon_.root() / "loops/kbgm.webp"; }

    RunningDaemon daemon_;
};

TEST_F(Loops, AVolumeThatComesIsInTheLoop) {
    daemon_.start(one_loop, with_program());
    ASSERT_TRUE(daemon_.wait_for([](const json& s) { return s["loops"]["running"] == 1; }))
        << daemon_.log();
    EXPECT_FALSE(fs::exists(output()));
    drop(testing::small_sequence[0]);
    ASSERT_TRUE(daemon_.wait_for([](const json& s) { return s["loops"]["made"] >= 1; }))
        << daemon_.log();
    EXPECT_GT(fs::file_size(output()), 1000U);
    drop(testing::small_sequence[1]);
    ASSERT_TRUE(daemon_.wait_for([](const json& s) {
        return s["loops"]["each"][0]["frames"] == 2;
    })) << daemon_.log();
    const pid_t loop = process();
    EXPECT_EQ(daemon_.terminate(), 0) << daemon_.log();
    EXPECT_TRUE(is_gone(loop));
    EXPECT_EQ(daemon_.status()["loops"]["running"], 0);
    for (const auto& entry : fs::directory_iterator(daemon_.root() / "loops"))
        EXPECT_EQ(entry.path(), output()) << "the file was left behind";
}

TEST_F(Loops, ThatOneWaitsForItsFirstGridIsSaidOnce) {
    daemon_.start(one_loop, with_program());
    EXPECT_TRUE(
        daemon_.wait_for_log("loop binghamton: note: there is no grid of domain 'KBGM' yet"))
        << daemon_.log();
    EXPECT_EQ(daemon_.terminate(), 0) << daemon_.log();
}

TEST_F(Loops, IngestGoesOnWithoutTheProgram) {
    daemon_.start(one_loop, {{"PATH", "/nowhere"}});
    ASSERT_TRUE(
        daemon_.wait_for_log("loop binghamton: cannot be started: there is no program stormcellar"))
        << daemon_.log();
    drop(testing::small_sequence[0]);
    EXPECT_TRUE(daemon_.wait_for([](const json& s) { return s["ingested"] == 1; }));
    EXPECT_EQ(daemon_.status()["loops"]["running"], 0);
    EXPECT_EQ(daemon_.terminate(), 0) << daemon_.log();
}

TEST_F(Loops, ALoopThatDiesIsStartedAgain) {
    daemon_.start(one_loop, with_program());
    ASSERT_TRUE(daemon_.wait_for_log("started as process")) << daemon_.log();
    ::kill(process(), SIGKILL);
    EXPECT_TRUE(daemon_.wait_for_log("loop binghamton: ended with signal 9")) << daemon_.log();
    EXPECT_TRUE(daemon_.wait_for([](const json& s) {
        return s["loops"]["restarts"] == 1 && s["loops"]["running"] == 1;
    })) << daemon_.log();
}

TEST_F(Loops, ALoopEndsWithADaemonThatIsKilled) {
    daemon_.start(one_loop, with_program());
    // Once the loop waits, it has already requested to end with its parent.
    ASSERT_TRUE(daemon_.wait_for_log("waiting for one")) << daemon_.log();
    const pid_t loop = process();
    daemon_.signal(SIGKILL);
    EXPECT_EQ(daemon_.wait(), -SIGKILL);
    EXPECT_TRUE(testing::eventually([&] { return is_gone(loop); }));
}

TEST_F(Loops, AReloadStartsAndStopsThem) {
    daemon_.start("", with_program());
    ASSERT_TRUE(daemon_.wait_for([](const json& s) { return s["state"] == "running"; }));
    EXPECT_EQ(daemon_.status()["loops"]["running"], 0);
    const fs::path file = daemon_.root() / "stormcellard.toml";
    const std::string paths = "[paths]\ndrop = \"drop\"\nstate = \"state\"\ncache = \"cache\"\n";
    write_file(file, paths + one_loop);
    daemon_.signal(SIGHUP);
    ASSERT_TRUE(daemon_.wait_for([](const json& s) { return s["loops"]["running"] == 1; }))
        << daemon_.log();
    write_file(file, paths);
    daemon_.signal(SIGHUP);
    EXPECT_TRUE(daemon_.wait_for([](const json& s) { return s["loops"]["each"].empty(); }))
        << daemon_.log();
    EXPECT_EQ(daemon_.terminate(), 0) << daemon_.log();
}

// 2026-11-22: the check accepted any existing file as a scene.
TEST(CheckConfig, LooksIntoTheLoopsScenes) {
    const testing::TemporaryDirectory directory;
    const auto check = [&](const std::string& scene, const std::string& loop,
                           const std::string& path) {
        write_file(directory / "scene.toml", scene);
        write_file(directory / "c.toml",
                   "[paths]\ndrop = \"none\"\n[[loop]]\nname = \"a\"\n" + loop);
        // `env` sets the PATH on which stormcellar is found.
        return testing::run_program("/usr/bin/env", {"PATH=" + path, STORMCELLARD, "--check-config",
                                                     "--config", (directory / "c.toml").native()});
    };
    const std::string& path = with_program().at("PATH");
    const std::string loop =
        "domain = \"KBGM\"\nscene = \"scene.toml\"\noutputs = [\"gone/a.webp\"]\n";
    const auto good = check("[picture]\nproduct = \"composite\"\n", loop, path);
    EXPECT_EQ(good.status, 0) << good.err;
    EXPECT_TRUE(good.out.ends_with("c.toml: ok\n")) << good.out;
    EXPECT_FALSE(fs::exists(directory / "gone")) << "the check makes no directory";
    const std::string gone = (directory / "gone").native();
    EXPECT_NE(good.err.find("stormcellard: note: [[loop]] a: " + gone +
                            "/a.webp: there is no directory " + gone + " (yet)"),
              std::string::npos)
        << good.err;
    EXPECT_EQ(good.err.find("neither a known station"), std::string::npos) << good.err;
    const auto unknown = check("", "domain = \"nosuch\"\noutputs = [\"a.webp\", \"b/\"]\n", path);
    EXPECT_EQ(unknown.status, 0);
    EXPECT_NE(unknown.err.find("stormcellard: note: [[loop]] a: domain 'nosuch' is neither a known "
                               "station nor a [[domain]]"),
              std::string::npos)
        << unknown.err;
    EXPECT_EQ(unknown.err.find("no directory"), std::string::npos) << unknown.err;

    const auto refused = [&](const testing::ProgramResult& ran, const std::string& why) {
        EXPECT_EQ(ran.status, 1);
        EXPECT_NE(ran.err.find("c.toml: [[loop]] a: "), std::string::npos) << ran.err;
        EXPECT_NE(ran.err.find(why), std::string::npos) << ran.err;
    };
    refused(check("[picture]\nproduct = \"hologram\"\n", loop, path),
            "scene.toml:2: [picture] product: there is no product 'hologram'");
    refused(check("[picture]\nproduct = \"vil\"\n[volume]\nhaze = true\n", loop, path),
            "scene.toml: [volume] haze is for volume; vil does not use it");
    refused(check("[picture]\nproduct = \"section\"\n", loop, path),
            "scene.toml: a section needs its two ends");
    refused(check("", "scene = \"scene.toml\"\noutputs = [\"a.webp\"]\n", path), "--domain");
    refused(check("", "domain = \"KBGM\"\noutputs = [\"a.xyz\"]\n", path),
            "the ending '.xyz' is not known");
    refused(check("", loop, "/nowhere"), "there is no program stormcellar");
}

}  // namespace
}  // namespace stormcellar::daemon
