// Tests loops in a process of their own: stormcellard --loops-only beside stormcellard --no-loops.
#include <csignal>
#include <filesystem>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "tests/daemon/notify_socket.h"
#include "tests/daemon/running_daemon.h"
#include "tests/daemon/status_client.h"
#include "tests/daemon/write_file.h"
#include "tests/testing/small_sequence.h"
#include "tests/testing/waiting.h"

namespace stormcellar::daemon {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* its_status = "loops/status.json";

// Runs loops of a cache that another daemon fills.
class LoopsOnly : public ::testing::Test {
  protected:
    void SetUp() override {
        fs::create_directory(loops_.root() / "out");
        loops_.write_scene();
    }
    static std::map<std::string, std::string> with_program() {
        return {{"PATH", fs::path(STORMCELLAR_PROGRAM).parent_path().native() + ":/usr/bin:/bin"}};
    }
    static std::string one_loop() {
        return "[[loop]]\nname = \"binghamton\"\nscene = \"scene.toml\"\ndomain = \"KBGM\"\n"
               "outputs = [\"out/kbgm.webp\"]\n";
    }
    // Waits until the metrics have this line. The daemon reads the loops' status file only every
    // few seconds.
    static bool has_metric(const RunningDaemon& daemon, const std::string& line) {
        const fs::path socket = daemon.root() / "state/status.sock";
        return testing::eventually([&] {
            const std::string said = StatusClient::at_path(socket).ask(get("/metrics"));
            return said.find(line) != std::string::npos;
        });
    }
    [[nodiscard]] bool comes(const std::function<bool(const json&)>& wanted) const {
        return loops_.wait_for(wanted, its_status);
    }

    RunningDaemon loops_;
};

TEST_F(LoopsOnly, KeepsWhatTheOtherDaemonGrids) {
    RunningDaemon ingest;
    fs::create_directory_symlink(ingest.root() / "cache", loops_.root() / "cache");
    fs::create_directory(ingest.root() / "cache");
    fs::create_directory(ingest.root() / "state");
    fs::create_directory_symlink(loops_.root() / "state/loops", ingest.root() / "state/loops");
    write_file(ingest.root() / "scene.toml", "[picture]\nproduct = \"composite\"\n");
    ingest.start(one_loop(), with_program(), {"--no-loops"});
    loops_.start(one_loop(), with_program(), {"--loops-only"});
    ASSERT_TRUE(comes([](const json& s) { return s["loops"]["running"] == 1; })) << loops_.log();
    testing::write_small_volume(testing::small_sequence[0],
                                ingest.drop() / testing::small_sequence[0]);
    ASSERT_TRUE(comes([](const json& s) { return s["loops"]["made"] >= 1; })) << loops_.log();
    EXPECT_GT(fs::file_size(loops_.root() / "out/kbgm.webp"), 1000U);
    EXPECT_EQ(ingest.status()["loops"]["elsewhere"], true)
        << "the ingesting daemon must not run the loops";
    EXPECT_TRUE(has_metric(ingest, "stormcellar_loop_running{loop=\"binghamton\"} 1\n"));
    ingest.signal(SIGHUP);
    ASSERT_TRUE(ingest.wait_for_log("reloaded")) << ingest.log();
    EXPECT_EQ(loops_.terminate(), 0) << loops_.log();
    EXPECT_TRUE(has_metric(ingest, "stormcellar_loop_running{loop=\"binghamton\"} 0\n"));
    EXPECT_EQ(ingest.terminate(), 0) << ingest.log();
    EXPECT_EQ(ingest.log().find("loop binghamton"), std::string::npos) << ingest.log();
    const json last = loops_.status(its_status);
    EXPECT_EQ(last["state"], "stopped");
    EXPECT_EQ(last["loops"]["running"], 0);
    EXPECT_FALSE(fs::exists(loops_.root() / "state/catalog")) << "this process must not ingest";
    EXPECT_FALSE(fs::exists(loops_.root() / "state/status.json"));
}

TEST_F(LoopsOnly, TellsTheManagerHowItIs) {
    NotifySocket socket(loops_.root() / "notify");
    auto environment = with_program();
    environment["NOTIFY_SOCKET"] = socket.path();
    environment["WATCHDOG_USEC"] = "400000";
    loops_.start(one_loop(), environment, {"--loops-only"});
    EXPECT_TRUE(socket.hears("STATUS=0 of 0 loops run, made 0"));
    EXPECT_TRUE(socket.hears("READY=1"));
    EXPECT_TRUE(socket.hears("STATUS=1 of 1 loops run, made 0")) << loops_.log();
    EXPECT_TRUE(socket.hears("WATCHDOG=1"));
    loops_.expect_reload_and_end(socket);
}

TEST_F(LoopsOnly, AReloadStartsAndStopsThem) {
    loops_.start("", with_program(), {"--loops-only"});
    ASSERT_TRUE(comes([](const json& s) { return s["state"] == "running"; })) << loops_.log();
    const fs::path file = loops_.root() / "stormcellard.toml";
    const std::string paths = "[paths]\ndrop = \"drop\"\nstate = \"state\"\ncache = \"cache\"\n";
    write_file(file, paths + one_loop());
    loops_.signal(SIGHUP);
    ASSERT_TRUE(comes([](const json& s) { return s["loops"]["running"] == 1; })) << loops_.log();
    write_file(file, paths);
    loops_.signal(SIGHUP);
    EXPECT_TRUE(comes([](const json& s) { return s["loops"]["each"].empty(); })) << loops_.log();
    EXPECT_EQ(loops_.terminate(), 0) << loops_.log();
}

TEST_F(LoopsOnly, ADaemonThatKeepsThemTooSaysSo) {
    loops_.start(one_loop(), with_program(), {"--loops-only"});
    ASSERT_TRUE(comes([](const json& s) { return s["loops"]["running"] == 1; })) << loops_.log();
    RunningDaemon both;
    fs::create_directory_symlink(loops_.root() / "state", both.root() / "state");
    write_file(both.root() / "scene.toml", "[picture]\nproduct = \"composite\"\n");
    both.start(one_loop(), with_program());
    EXPECT_TRUE(both.wait_for_log("another process runs the same loops")) << both.log();
    EXPECT_EQ(both.terminate(), 0) << both.log();
    EXPECT_EQ(loops_.terminate(), 0) << loops_.log();
}

// Two services with the same state directory would write the same files.
TEST_F(LoopsOnly, OneAStateDirectory) {
    loops_.start("", with_program(), {"--loops-only"});
    ASSERT_TRUE(comes([](const json& s) { return s["state"] == "running"; })) << loops_.log();
    RunningDaemon second;
    fs::create_directory_symlink(loops_.root() / "state", second.root() / "state");
    second.start("", with_program(), {"--loops-only"});
    EXPECT_EQ(second.wait(), 1);
    EXPECT_NE(second.log().find("another stormcellard"), std::string::npos) << second.log();
    RunningDaemon both;
    both.start("", with_program(), {"--loops-only", "--no-loops"});
    EXPECT_EQ(both.wait(), 2);
    EXPECT_NE(both.log().find("usage:"), std::string::npos) << both.log();
}

}  // namespace
}  // namespace stormcellar::daemon
