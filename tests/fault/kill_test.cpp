// kill -9 at random moments, under load.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <random>
#include <thread>

#include <gtest/gtest.h>

#include "tests/fault/faulty_daemon.h"
#include "tests/fault/load.h"

namespace stormcellar::fault {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

// The window reaches from before main() to the midst of work. More comes the longer it lasts, and
// never so much that the daemon, which is killed before it has caught up, falls behind for good.
TEST(Kill, AtRandomMomentsUnderLoad) {
    const int kills = number_of("STORMCELLAR_KILLS", 15);
    const auto seed = static_cast<std::uint32_t>(number_of("STORMCELLAR_SEED", 1));
    std::mt19937 random(seed);
    std::uniform_int_distribution<int> window_us(0, 300'000);
    const auto began = Clock::now();
    FaultyDaemon daemon;
    Feed feed(daemon.drop(), seed, std::chrono::milliseconds{4});
    for (int kill = 0; kill < kills; ++kill) {
        feed.allow(5 + 2 * kill);
        daemon.start();
        std::this_thread::sleep_for(std::chrono::microseconds{window_us(random)});
        daemon.kill();
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
    std::printf("kills: %d in %.0f s, %zu of %zu files settled by then; %s\n", kills, killing_s,
                settled_before, after.files, after.summary().c_str());
}

}  // namespace
}  // namespace stormcellar::fault
