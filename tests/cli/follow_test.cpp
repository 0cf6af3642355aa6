// Runs `stormcellar loop --follow` as a user does.
#include <algorithm>
#include <array>
#include <csignal>
#include <cstring>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/inotify.h>
#include <unistd.h>

#include "stormcellar/base/descriptor.h"
#include "tests/cli/loop_fixture.h"
#include "tests/testing/file_bytes.h"
#include "tests/testing/waiting.h"

namespace stormcellar::cli {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::RunningProgram;

class Follow : public Loop {
  protected:
    [[nodiscard]] Words arguments(const Words& more) const {
        // Draw few slices, which is quick; only volumes have slices.
        const Words few = has(more, "--product") ? Words{} : Words{"--slices", "16"};
        return with({"loop", "KBGM", "--cache", directory_ / "cache", "--follow", "--json"}, few,
                    more);
    }
    // Returns the JSON documents printed so far, one for each loop.
    static std::vector<nlohmann::json> documents(const RunningProgram& program) {
        std::istringstream lines(program.out());
        std::vector<nlohmann::json> all;
        for (std::string line; std::getline(lines, line) && !lines.eof();)
            all.push_back(nlohmann::json::parse(line));
        return all;
    }
    static bool wait_for_remakes(const RunningProgram& program, std::size_t count) {
        return testing::eventually([&] { return documents(program).size() >= count; });
    }
};

// Returns true if the process handles SIGTERM. Without a handler, the signal would just end the
// process.
bool catches_sigterm(pid_t id) {
    std::ifstream status("/proc/" + std::to_string(id) + "/status");
    for (std::string line; std::getline(status, line);) {
        if (!line.starts_with("SigCgt:")) continue;
        return (std::stoull(line.substr(7), nullptr, 16) >> (SIGTERM - 1) & 1U) != 0;
    }
    return false;
}

// Counts how often the directory is opened after the constructor. The program opens the directory
// for each check.
class Openings {
  public:
    explicit Openings(const fs::path& directory) {
        EXPECT_GE(::inotify_add_watch(events_.number(), directory.c_str(), IN_OPEN), 0);
    }
    [[nodiscard]] bool come_to(std::size_t count) {
        return testing::eventually([&] {
            // Events of entries of the directory have names; events of the directory itself have no
            // name.
            alignas(inotify_event) std::array<char, 4096> events;
            ssize_t size = 0;
            while ((size = ::read(events_.number(), events.data(), events.size())) > 0) {
                for (ssize_t at = 0; at < size;) {
                    inotify_event event{};
                    std::memcpy(&event, events.data() + at, sizeof event);
                    if (event.len == 0) ++count_;
                    at += static_cast<ssize_t>(sizeof event + event.len);
                }
            }
            return count_ >= count;
        });
    }

  private:
    const Descriptor events_{::inotify_init1(IN_NONBLOCK | IN_CLOEXEC)};
    std::size_t count_ = 0;
};

TEST_F(Follow, IsMadeAgainWhenGridsComeAndGo) {
    commit("20050822_024400", 22);
    RunningProgram program(STORMCELLAR_PROGRAM, arguments({"-o", out("a.gif")}));
    ASSERT_TRUE(wait_for_remakes(program, 1)) << program.err();
    const auto second = commit("20050822_025000", 33);
    ASSERT_TRUE(wait_for_remakes(program, 2)) << program.err();
    EXPECT_THAT(written(), ElementsAre("a.gif"));
    commit("20050822_025000", 44);  // the volume has grown: the same time, a new grid
    ASSERT_TRUE(wait_for_remakes(program, 3)) << program.err();
    fs::remove(second);
    ASSERT_TRUE(wait_for_remakes(program, 4)) << program.err();
    EXPECT_EQ(program.end(SIGINT), 0) << program.err();
    std::vector<int> frames;
    for (const auto& document : documents(program))
        frames.push_back(document["frames"]);
    EXPECT_THAT(frames, ElementsAre(1, 2, 2, 1));
    EXPECT_EQ(program.err(), "");
}

// Frames are kept from loop to loop, which must not change the result. The options fix the view,
// because a followed loop keeps its first view as long as that view fits.
TEST_F(Follow, IsTheLoopThatOneMakesAtOnce) {
    const Words view = words(
        "--azimuth 180 --tilt 55 --zoom 1 --exaggeration 5 --opacity 1 --sun 225,40 "
        "--field-of-view 0");
    for (const char* more : {"--orbit=90", "--ping-pong", "--product=volume"}) {
        const Words plain = with(view, {more});
        commit("20050822_024400", 22);
        const auto middle = commit("20050822_025000", 33);
        RunningProgram program(STORMCELLAR_PROGRAM, arguments(with(plain, {"-o", out("a.webp")})));
        ASSERT_TRUE(wait_for_remakes(program, 1)) << program.err();
        commit("20050822_025600", 44);
        ASSERT_TRUE(wait_for_remakes(program, 2)) << program.err();
        fs::remove(middle);
        ASSERT_TRUE(wait_for_remakes(program, 3)) << program.err();
        EXPECT_EQ(program.end(SIGINT), 0);
        auto once = arguments(with(plain, {"-o", out("b.webp")}));
        once.erase(std::find(once.begin(), once.end(), "--follow"));
        ASSERT_EQ(testing::run_stormcellar(once).status, 0);
        EXPECT_TRUE(testing::file_text(out("a.webp")) == testing::file_text(out("b.webp"))) << more;
    }
}

TEST_F(Follow, NothingIsMadeWithoutAChangeOfItsGrids) {
    commit("20050822_024400", 22);
    commit("20050822_025000", 33);
    const auto grid = commit("20050822_025600", 44);
    RunningProgram program(STORMCELLAR_PROGRAM, arguments({"--last", "2", "-o", out("a.gif")}));
    ASSERT_TRUE(wait_for_remakes(program, 1)) << program.err();
    std::ofstream(grid.native() + ".pin") << "";
    commit("20050822_024000", 11);  // not among the last two
    // The program lists the grids after some seven checks without a change, and goes on checking.
    // So 20 checks show that the listing started no second loop.
    EXPECT_TRUE(Openings(grid.parent_path().parent_path()).come_to(20));
    EXPECT_EQ(documents(program).size(), 1U) << program.out();
    EXPECT_EQ(program.end(SIGTERM), 0);
}

TEST_F(Follow, WaitsForTheFirstGridOfADomain) {
    RunningProgram program(STORMCELLAR_PROGRAM, arguments({"-o", out("a.webp")}));
    ASSERT_TRUE(testing::eventually([&] { return !program.err().empty(); }));
    EXPECT_THAT(program.err(), HasSubstr("there is no grid of domain 'KBGM' yet; waiting for one"));
    EXPECT_THAT(written(), IsEmpty());
    commit("20050822_024400", 22);
    ASSERT_TRUE(wait_for_remakes(program, 1)) << program.err();
    EXPECT_THAT(written(), ElementsAre("a.webp"));
    EXPECT_EQ(program.end(SIGINT), 0);
}

TEST_F(Follow, WaitsForTheCache) {
    fs::remove_all(directory_ / "cache");
    RunningProgram program(STORMCELLAR_PROGRAM, arguments({"-o", out("a.webp")}));
    ASSERT_TRUE(testing::eventually([&] { return !program.err().empty(); }));
    EXPECT_THAT(
        program.err(),
        HasSubstr("there is no cache here yet; there is no grid of domain 'KBGM' yet; waiting"));
    store_ = *cache::StoreWriter::open(real_file_system(), directory_ / "cache", true);
    commit("20050822_024400", 22);
    ASSERT_TRUE(wait_for_remakes(program, 1)) << program.err();
    EXPECT_THAT(written(), ElementsAre("a.webp"));
    EXPECT_EQ(program.end(SIGINT), 0);
    fs::remove_all(directory_ / "cache");
    const auto refused = testing::run_stormcellar(arguments({"-o", out("a.gif"), "--from", "eve"}));
    EXPECT_EQ(refused.status, 2) << "an invalid request is refused even without a cache";
}

TEST_F(Follow, ABurstIsOneRemake) {
    commit("20050822_024400", 22);
    RunningProgram program(STORMCELLAR_PROGRAM, arguments({"-o", out("a.gif")}));
    ASSERT_TRUE(wait_for_remakes(program, 1)) << program.err();
    for (int i = 0; i < 5; ++i)
        commit("20050822_02500" + std::to_string(i), 33);
    ASSERT_TRUE(testing::eventually([&] {
        const auto all = documents(program);
        return all.back()["frames"] == 6;
    })) << program.out();
    EXPECT_LE(documents(program).size(), 3U) << "on a slow machine the burst may make two loops";
    EXPECT_EQ(program.end(SIGINT), 0);
}

TEST_F(Follow, GoesOnAfterALoopThatCannotBeMade) {
    std::ofstream(commit("20050822_024400", 22), std::ios::trunc) << "no grid";
    RunningProgram program(STORMCELLAR_PROGRAM, arguments({"-o", out("a.gif")}));
    ASSERT_TRUE(testing::eventually([&] {
        return program.err().find("nothing was written") != std::string::npos;
    })) << program.err();
    commit("20050822_025000", 33);
    ASSERT_TRUE(wait_for_remakes(program, 1)) << program.err();
    EXPECT_EQ(documents(program)[0]["skipped"].size(), 1U);
    // Remove the directory of the output.
    fs::remove_all(directory_ / "out");
    commit("20050822_025600", 44);
    ASSERT_TRUE(testing::eventually([&] {
        return program.err().find("there is no directory") != std::string::npos;
    })) << program.err();
    fs::create_directory(directory_ / "out");
    commit("20050822_030200", 11);
    ASSERT_TRUE(wait_for_remakes(program, 2)) << program.err();
    EXPECT_EQ(documents(program)[1]["frames"], 3);
    EXPECT_THAT(written(), ElementsAre("a.gif"));
    EXPECT_EQ(program.end(SIGINT), 0);
}

TEST_F(Follow, ASignalWhileItDrawsLeavesNothingUnfinished) {
    for (int i = 0; i < 50; ++i)
        commit("20050822_02" + std::to_string(10 + i) + "00", 22);
    RunningProgram program(STORMCELLAR_PROGRAM,
                           arguments({"--width", "1600", "--height", "1200", "-o", out("a.webp")}));
    ASSERT_TRUE(testing::eventually([&] { return catches_sigterm(program.id()); }));
    EXPECT_EQ(program.end(SIGTERM), 0) << program.err();
    for (const std::string& name : written())
        EXPECT_EQ(name, "a.webp");
}

TEST_F(Follow, WhatCanNeverBeMadeIsRefusedAtOnce) {
    const auto refused = [&](const Words& more) { return cli::run(arguments(more)); };
    EXPECT_EQ(refused({"-o", out("a.xyz")}).status, 2);
    EXPECT_EQ(refused({"-o", out("a.gif"), "--from", "yesterday"}).status, 2);
    EXPECT_EQ(refused({"-o", out("a.gif"), "--zoom", "0"}).status, 2);
    commit("20050822_024400", 22);
    const auto high = refused({"-o", out("a.gif"), "--product", "cappi", "--height-km", "50"});
    EXPECT_EQ(high.status, 2) << "no grid has that height: " << high.err;
}

TEST_F(Follow, EndsWithItsParent) {
    commit("20050822_024400", 22);
    // The program is not a child of process 1, its stated parent, so it assumes that its parent has
    // ended.
    const auto orphan =
        testing::run_stormcellar(arguments({"--with-parent", "1", "-o", out("a.gif")}));
    EXPECT_EQ(orphan.status, 0);
    EXPECT_EQ(orphan.out, "");
    RunningProgram program(
        STORMCELLAR_PROGRAM,
        arguments({"--with-parent", std::to_string(::getpid()), "-o", out("a.gif")}));
    EXPECT_TRUE(wait_for_remakes(program, 1)) << program.err();
    EXPECT_EQ(program.end(SIGTERM), 0);
}

}  // namespace
}  // namespace stormcellar::cli
