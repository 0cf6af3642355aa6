// Kills the daemon (kill -9) at random moments under load.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "stormcellar/base/file_system.h"
#include "tests/daemon/write_file.h"
#include "tests/fault/faulty_daemon.h"
#include "tests/fault/load.h"
#include "tests/testing/waiting.h"

namespace stormcellar::fault {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

// Returns true if the cache has a temporary file. The daemon's start removed the files of earlier
// kills, so this file is of a write that the last kill interrupted.
bool is_in_a_write(const std::filesystem::path& cache) {
    if (!std::filesystem::exists(cache)) return false;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(cache))
        if (entry.path().filename().native().starts_with(temporary_prefix)) return true;
    return false;
}

// The time of the kill ranges from before main() to the middle of the work. After each kill, at
// most four more shipments (files or volumes) arrive, so that the daemon catches up although it is
// killed again and again.
TEST(Kill, AtRandomMomentsUnderLoad) {
    const int kills = number_of("STORMCELLAR_KILLS", 15);
    const auto seed = static_cast<std::uint32_t>(number_of("STORMCELLAR_SEED", 1));
    std::mt19937 random(seed);
    std::uniform_int_distribution<int> start_us(0, 40'000), work_us(0, 300'000);
    const auto began = Clock::now();
    FaultyDaemon daemon;
    int at_start = 0, in_a_write = 0;
    Shipments shipments(daemon.drop(), seed);
    if (kills >= 100) shipments.have_patience();
    Feed feed(std::move(shipments), seed, std::chrono::milliseconds{2});
    for (int kill = 0; kill < kills; ++kill) {
        feed.allow(10 + 4 * kill);
        daemon.start();
        testing::pass_time(
            std::chrono::microseconds{kill % 3 == 0 ? start_us(random) : work_us(random)});
        daemon.kill();
        if (!std::filesystem::exists(daemon.places().state / "status.json")) ++at_start;
        if (is_in_a_write(daemon.places().cache)) ++in_a_write;
    }
    const double killing_s = seconds_since(began);
    const std::size_t settled_before = daemon.settled();
    const std::vector<Delivered> delivered = feed.finish();
    daemon.start();
    EXPECT_TRUE(daemon.catches_up(files_of(delivered), 240)) << daemon.log_end();
    EXPECT_EQ(daemon.stop(), 0) << daemon.log_end();
    const Aftermath after = look_at_aftermath(daemon.places(), delivered);
    EXPECT_TRUE(after.holds()) << after.problem_text() << daemon.log_end();
    EXPECT_EQ(after.gridded, after.volumes);
    EXPECT_EQ(after.set_aside, 0U);
    std::printf(
        "kills: %d in %.0f s, %d before it was ready, %d in the midst of a grid's file, %zu of %zu "
        "files settled by then; %s\n",
        kills, killing_s, at_start, in_a_write, settled_before, after.files,
        after.summary().c_str());
    std::fflush(stdout);
}

// 2026-11-28: a tar that took all memory killed the process at each start, until systemd gave up.
TEST(Kill, AFileThatEndsTheProcessIsLastAndThenGivenUp) {
    for (const int ends : {0, 5}) {
        daemon::RunningDaemon daemon;
        const std::filesystem::path bomb = daemon.drop() / "KTLX20130520_201643_V06";
        daemon::write_file(bomb, "no volume");
        struct stat facts {};
        ASSERT_EQ(::stat(bomb.c_str(), &facts), 0);
        std::filesystem::create_directories(daemon.root() / "state");
        daemon::write_file(daemon.root() / "state/tried",
                           fmt::format("{} 1 {} {} {}", ends, facts.st_size,
                                       facts.st_mtim.tv_sec * 1'000'000'000 + facts.st_mtim.tv_nsec,
                                       bomb.native()) +
                               '\0');
        daemon.start();
        if (ends == 0) {
            EXPECT_TRUE(daemon.wait_for_log("was being read when the service ended; it waits 2 s"));
        }
        EXPECT_TRUE(daemon.wait_for_log(
            ends == 0 ? "rejected" : "given up: the service ended 6 times while it read it"));
        EXPECT_EQ(daemon.terminate(), 0);
    }
}

}  // namespace
}  // namespace stormcellar::fault
