#include "service/notify.h"

#include <cstdlib>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/daemon/notify_socket.h"
#include "tests/daemon/steady_start.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar {
namespace {

using daemon::NotifySocket;
using daemon::t0;
using std::chrono::microseconds;
using std::chrono::seconds;

TEST(Notify, ReachesTheSocketOfTheManager) {
    const testing::TemporaryDirectory directory;
    NotifySocket socket(directory / "notify");
    ::setenv("NOTIFY_SOCKET", socket.path().c_str(), 1);
    SystemdNotifier notifier;
    notifier.send("READY=1");
    ::unsetenv("NOTIFY_SOCKET");
    EXPECT_EQ(socket.receive(), "READY=1");
    notifier.send("STOPPING=1");
    EXPECT_EQ(socket.receive(), "") << "if nobody listens, nothing is sent and nothing fails";
}

TEST(Notify, ReloadingComesWithTheMonotonicTime) {
    const std::string state = reloading_state();
    ASSERT_TRUE(state.starts_with("RELOADING=1\nMONOTONIC_USEC="));
    EXPECT_GT(std::stoll(state.substr(state.rfind('=') + 1)), 0);
}

TEST(Notify, TheWatchdogIsOnWhenItIsMeantForThisProcess) {
    const SystemdNotifier notifier;
    EXPECT_FALSE(notifier.watchdog());
    ::setenv("WATCHDOG_USEC", "5000000", 1);
    ::setenv("WATCHDOG_PID", fmt::format("{}", ::getpid()).c_str(), 1);
    EXPECT_EQ(notifier.watchdog(), seconds{5});
    ::setenv("WATCHDOG_PID", "1", 1);
    EXPECT_FALSE(notifier.watchdog());
    ::unsetenv("WATCHDOG_USEC");
    ::unsetenv("WATCHDOG_PID");
}

TEST(Watchdog, IsFedFourTimesAPeriod) {
    WatchdogFeed watchdog(seconds{8});
    int fed = 0;
    for (int ms = 0; ms < 8000; ms += 100)
        fed += watchdog.is_due(t0 + std::chrono::milliseconds{ms}, std::nullopt) ? 1 : 0;
    EXPECT_EQ(fed, 4);
}

TEST(Watchdog, IsNotFedWhileAThreadIsStuck) {
    WatchdogFeed watchdog(seconds{8});
    const Step step{"caretaker", t0 - seconds{8}};
    EXPECT_TRUE(watchdog.is_due(t0, step));
    EXPECT_FALSE(watchdog.is_due(t0 + seconds{3}, step)) << "the thread has been 11 s at one step";
    EXPECT_TRUE(watchdog.is_due(t0 + seconds{6}, std::nullopt)) << "the step has ended";
}

TEST(Watchdog, DoesNothingWhenThereIsNone) {
    WatchdogFeed watchdog(std::nullopt);
    EXPECT_FALSE(watchdog.is_due(t0, std::nullopt));
    EXPECT_FALSE(watchdog.next_time());
}

// A hang must be reported even without a watchdog, so that the log shows it.
TEST(Watchdog, AHangIsNamedOnce) {
    for (const auto period :
         {std::optional<microseconds>{seconds{8}}, std::optional<microseconds>{}}) {
        WatchdogFeed watchdog(period);
        const auto limit = period.value_or(WatchdogFeed::without_watchdog);
        EXPECT_FALSE(watchdog.hangs_now(t0, std::nullopt));
        EXPECT_FALSE(watchdog.hangs_now(t0 + limit, Step{"cache", t0}));
        EXPECT_TRUE(watchdog.hangs_now(t0 + limit + seconds{1}, Step{"cache", t0}));
        EXPECT_FALSE(watchdog.hangs_now(t0 + limit + seconds{2}, Step{"cache", t0}))
            << "the hang was reported before";
        EXPECT_FALSE(watchdog.hangs_now(t0 + limit + seconds{3}, std::nullopt))
            << "the thread went on";
        EXPECT_TRUE(watchdog.hangs_now(t0 + 3 * limit, Step{"cache", t0 + limit}))
            << "the next step hangs, too";
    }
}

TEST(Watchdog, LongWorkThatMovesOnIsNoHang) {
    WatchdogFeed watchdog(seconds{8});
    Pulses pulses;
    Pulse pulse;
    pulses.watch("caretaker", pulse);
    for (int second = 0; second < 3600; ++second) {
        if (second % 8 == 0) pulse.beat(t0 + seconds{second});
        EXPECT_EQ(watchdog.is_due(t0 + seconds{second}, pulses.oldest()), second % 2 == 0);
        EXPECT_FALSE(watchdog.hangs_now(t0 + seconds{second}, pulses.oldest()));
    }
    EXPECT_FALSE(watchdog.is_due(t0 + seconds{3602}, pulses.oldest()))
        << "the thread then stays at one step";
}

TEST(Watchdog, TheOldestStepOfAllCounts) {
    Pulses pulses;
    Pulse one;
    Pulse two;
    pulses.watch("one", one);
    pulses.watch("two", two);
    EXPECT_FALSE(pulses.oldest()) << "all threads are at rest";
    one.beat(t0 + seconds{2});
    two.beat(t0 + seconds{1});
    EXPECT_EQ(pulses.oldest()->who, "two");
    EXPECT_EQ(pulses.oldest()->since, t0 + seconds{1});
    two.beat(t0 + seconds{3});
    EXPECT_EQ(pulses.oldest()->who, "one");
    one.rest();
    EXPECT_EQ(pulses.oldest()->who, "two");
    {
        const SteadyTime before = std::chrono::steady_clock::now();
        const AtWork at_work(two);
        EXPECT_GE(*two.since(), before);
    }
    EXPECT_FALSE(pulses.oldest());
}

}  // namespace
}  // namespace stormcellar
