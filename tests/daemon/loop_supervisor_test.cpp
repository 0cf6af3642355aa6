#include "daemon/loops/loop_supervisor.h"

#include <atomic>
#include <chrono>
#include <csignal>
#include <fstream>
#include <functional>
#include <memory>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/daemon/write_file.h"
#include "tests/testing/temporary_directory.h"
#include "tests/testing/waiting.h"

namespace stormcellar::daemon {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class LoopKeeperTest : public ::testing::Test {
  protected:
    // Makes a program that the supervisor runs in place of stormcellar. The program first adds a
    // line "start PID ARGUMENTS" to `log`.
    fs::path program(const std::string& body) {
        const fs::path path = directory_ / "program";
        write_file(path, "#!/bin/sh\necho start $$ \"$*\" >>" + log().native() + "\n" + body);
        fs::permissions(path, fs::perms::owner_all);
        return path;
    }
    void keep(const fs::path& program) {
        keeper_ = std::make_unique<LoopSupervisor>(
            "/the/cache", [this] { ++wakes_; }, program);
    }
    bool wait_for(const std::function<bool()>& seen) {
        return testing::eventually([&] {
            if (auto states = keeper_->news()) states_ = std::move(*states);
            return seen();
        });
    }
    std::vector<std::string> starts() const {
        std::ifstream file(log());
        std::vector<std::string> lines;
        for (std::string line; std::getline(file, line);)
            lines.push_back(line);
        return lines;
    }
    static pid_t process_of(const std::string& start) { return std::stoi(start.substr(6)); }
    static LoopConfig loop(const std::string& name, const std::string& domain) {
        return {.name = name, .scene = {}, .domain = domain, .outputs = {"/o/" + name + ".webp"}};
    }
    [[nodiscard]] fs::path log() const { return directory_ / "log"; }

    testing::TemporaryDirectory directory_;
    std::atomic<int> wakes_ = 0;
    std::vector<LoopState> states_;
    std::unique_ptr<LoopSupervisor> keeper_;
};

constexpr const char* for_ever = "while true; do sleep 0.05; done\n";

TEST_F(LoopKeeperTest, WhatEndsIsStartedAgain) {
    keep(program("echo '{\"frames\": 3, \"total_s\": 0.5}'\necho it broke >&2\nexit 7\n"));
    keeper_->set({loop("ktlx", "KTLX")});
    ASSERT_TRUE(wait_for([&] { return !states_.empty() && states_[0].restarts >= 2; }));
    ASSERT_TRUE(wait_for([&] { return states_[0].made >= 3; }));
    EXPECT_EQ(states_[0].name, "ktlx");
    EXPECT_EQ(states_[0].frames, 3);
    EXPECT_TRUE(states_[0].last_made);
    EXPECT_EQ(states_[0].last_problem, "status 7: it broke");
    EXPECT_GT(wakes_, 0);
    const std::string first = starts().at(0);
    EXPECT_THAT(first,
                HasSubstr("loop --follow --json --cache /the/cache --with-parent " +
                          std::to_string(::getpid()) + " --domain KTLX --output /o/ktlx.webp"));
}

TEST_F(LoopKeeperTest, AProgramThatIsNotThereIsSaid) {
    keep(directory_ / "none");
    keeper_->set({loop("ktlx", "KTLX")});
    ASSERT_TRUE(wait_for([&] { return !states_.empty() && !states_[0].last_problem.empty(); }));
    EXPECT_FALSE(states_[0].is_running);
    EXPECT_THAT(states_[0].last_problem, HasSubstr("No such file or directory"));
    EXPECT_EQ(states_[0].restarts, 0U);
    // The program may appear later.
    fs::rename(program(for_ever), directory_ / "none");
    EXPECT_TRUE(wait_for([&] { return states_[0].is_running; }));
}

TEST_F(LoopKeeperTest, AKilledLoopIsStartedAgain) {
    keep(program(for_ever));
    keeper_->set({loop("ktlx", "KTLX")});
    ASSERT_TRUE(wait_for([&] { return starts().size() == 1; }));
    ASSERT_EQ(::kill(process_of(starts()[0]), SIGKILL), 0);
    ASSERT_TRUE(wait_for([&] { return starts().size() == 2 && states_[0].is_running; }));
    EXPECT_EQ(states_[0].last_problem, "signal 9");
}

// 2026-11-22: the log gave "signal 9: note: no grid ...; waiting for one" as the reason of an end
// minutes after that note.
TEST_F(LoopKeeperTest, AnOldLineIsNoReasonOfAnEnd) {
    keep(program(
        "echo 'note: waiting' >&2\nsleep 0.2\necho '{\"frames\": 3}'\nsleep 0.2\nexit 7\n"));
    keeper_->set({loop("ktlx", "KTLX")});
    ASSERT_TRUE(wait_for([&] { return !states_.empty() && !states_[0].last_problem.empty(); }));
    EXPECT_EQ(states_[0].last_problem, "status 7");
    keep(program(
        std::string("echo 'note: waiting' >&2\ntouch " + (directory_ / "said").native() + "\n") +
        for_ever));
    states_.clear();
    const std::size_t before = starts().size();
    keeper_->set({loop("ktlx", "KTLX")});
    ASSERT_TRUE(wait_for([&] { return fs::exists(directory_ / "said"); }));
    ASSERT_EQ(::kill(process_of(starts().at(before)), SIGKILL), 0);
    ASSERT_TRUE(wait_for([&] { return !states_.empty() && !states_[0].last_problem.empty(); }));
    EXPECT_EQ(states_[0].last_problem, "signal 9");
}

TEST_F(LoopKeeperTest, OnlyWhatChangesIsStoppedAndStarted) {
    keep(program(for_ever));
    keeper_->set({loop("a", "AAAA"), loop("b", "BBBB"), loop("c", "CCCC")});
    ASSERT_TRUE(wait_for([&] { return starts().size() == 3; }));
    pid_t a = 0;
    pid_t b = 0;
    pid_t c = 0;
    for (const std::string& start : starts()) {
        if (start.find("AAAA") != std::string::npos) a = process_of(start);
        if (start.find("BBBB") != std::string::npos) b = process_of(start);
        if (start.find("CCCC") != std::string::npos) c = process_of(start);
    }
    keeper_->set({loop("a", "AAAA"), loop("b", "ZZZZ")});
    ASSERT_TRUE(wait_for([&] { return starts().size() == 4; }));
    EXPECT_THAT(starts().back(), HasSubstr("ZZZZ"));
    ASSERT_TRUE(wait_for([&] { return ::kill(c, 0) != 0; }));
    EXPECT_NE(::kill(b, 0), 0) << "the changed loop starts after its old process ends";
    EXPECT_EQ(::kill(a, 0), 0) << "an unchanged loop goes on";
    ASSERT_TRUE(wait_for([&] { return states_.size() == 2; }));
    EXPECT_EQ(states_[0].restarts + states_[1].restarts, 0U);
}

TEST_F(LoopKeeperTest, AChangedSceneIsAChange) {
    keep(program(for_ever));
    LoopConfig scened = loop("a", "AAAA");
    scened.scene = directory_ / "scene.toml";
    write_file(scened.scene, "[picture]\n");
    keeper_->set({scened});
    ASSERT_TRUE(wait_for([&] { return starts().size() == 1; }));
    EXPECT_THAT(starts()[0], HasSubstr("--scene " + scened.scene.native()));
    keeper_->set({scened});
    keeper_->set({scened, loop("b", "BBBB")});
    ASSERT_TRUE(wait_for([&] { return starts().size() == 2; }));
    EXPECT_THAT(starts()[1], HasSubstr("BBBB")) << "the other loop had not changed";
    write_file(scened.scene, "[picture]\nwidth = 500\n");
    keeper_->set({scened, loop("b", "BBBB")});
    ASSERT_TRUE(wait_for([&] { return starts().size() == 3; }));
    EXPECT_THAT(starts()[2], HasSubstr("AAAA"));
}

TEST_F(LoopKeeperTest, AllEndWithIt) {
    keep(program(for_ever));
    keeper_->set({loop("a", "AAAA"), loop("b", "BBBB")});
    ASSERT_TRUE(wait_for([&] { return starts().size() == 2; }));
    keeper_->stop();
    keeper_->wait();
    for (const std::string& start : starts())
        EXPECT_NE(::kill(process_of(start), 0), 0) << start;
    EXPECT_EQ(starts().size(), 2U);
}

TEST_F(LoopKeeperTest, WhatDoesNotListenIsKilled) {
    keep(program(std::string("trap '' TERM\necho ready >&2\n") + for_ever));
    keeper_->set({loop("a", "AAAA")});
    ASSERT_TRUE(wait_for([&] { return starts().size() == 1; }));
    keeper_.reset();
    EXPECT_NE(::kill(process_of(starts()[0]), 0), 0);
}

// The thread must be at rest between the passes of its loop (turns), however long the time between
// two turns is. Otherwise the watchdog would see a hang.
TEST_F(LoopKeeperTest, RestsBetweenItsTurns) {
    keep(program("sleep 100\n"));
    EXPECT_FALSE(keeper_->pulse().since()) << "without loops there is no thread that could hang";
    keeper_->set({loop("one", "KTLX")});
    ASSERT_TRUE(wait_for([&] { return starts().size() == 1; }));
    EXPECT_TRUE(wait_for([&] { return !keeper_->pulse().since(); }));
}

// Blocks the thread in the middle of its turn, when the thread reports news.
TEST_F(LoopKeeperTest, IsSeenToHangInATurn) {
    std::atomic<bool> hangs = true, is_reporting = false;
    keeper_ = std::make_unique<LoopSupervisor>(
        "/the/cache",
        [&] {
            is_reporting = true;
            (void)testing::eventually([&] { return !hangs; });
        },
        program("sleep 100\n"));
    const SteadyTime before = std::chrono::steady_clock::now();
    keeper_->set({loop("one", "KTLX")});
    const bool is_blocked = testing::eventually([&] { return is_reporting.load(); });
    const auto since = keeper_->pulse().since();
    hangs = false;
    ASSERT_TRUE(is_blocked);
    ASSERT_TRUE(since) << "the thread must be at work";
    EXPECT_GE(*since, before);
    EXPECT_TRUE(wait_for([&] { return !keeper_->pulse().since(); })) << "the thread must go on";
}

TEST(LoopArguments, SayWhatTheTableSays) {
    const LoopConfig all{.name = "n",
                         .scene = "/s.toml",
                         .domain = "north",
                         .last = 12,
                         .seconds = 5400,
                         .outputs = {"/a.webp", "/b/"}};
    EXPECT_THAT(arguments_of(all, "/c", 7),
                ElementsAre("loop", "--follow", "--json", "--cache", "/c", "--with-parent", "7",
                            "--scene", "/s.toml", "--domain", "north", "--last", "12",
                            "--from=-5400s", "--output", "/a.webp", "--output", "/b/"));
    LoopConfig scene_alone;
    scene_alone.name = "n";
    scene_alone.scene = "/s.toml";
    EXPECT_THAT(arguments_of(scene_alone, "/c", 7),
                ElementsAre("loop", "--follow", "--json", "--cache", "/c", "--with-parent", "7",
                            "--scene", "/s.toml"));
}

TEST(LineReader, GivesWholeLinesAndTheRestAtTheEnd) {
    int ends[2] = {};
    ASSERT_EQ(::pipe(ends), 0);
    ASSERT_EQ(::fcntl(ends[0], F_SETFL, O_NONBLOCK), 0);
    LineReader reader{Descriptor(ends[0])};
    const auto write = [&](const std::string& text) {
        ASSERT_EQ(::write(ends[1], text.data(), text.size()), static_cast<ssize_t>(text.size()));
    };
    EXPECT_THAT(reader.read(), ElementsAre());
    write("one\ntw");
    EXPECT_THAT(reader.read(), ElementsAre("one"));
    write("o\n" + std::string(10'000, 'x') + "\nrest");
    const auto lines = reader.read();
    ASSERT_EQ(lines.size(), 2U);
    EXPECT_EQ(lines[0], "two");
    EXPECT_EQ(lines[1].size(), LineReader::longest_line);
    ::close(ends[1]);
    EXPECT_THAT(reader.read(), ElementsAre("rest"));
    EXPECT_EQ(reader.descriptor(), -1);
    EXPECT_THAT(reader.read(), ElementsAre());
}

}  // namespace
}  // namespace stormcellar::daemon
