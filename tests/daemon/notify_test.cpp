#include "daemon/notify.h"

#include <cstdlib>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/daemon/notify_socket.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::daemon {
namespace {

using std::chrono::microseconds;
using std::chrono::seconds;

const SteadyTime t0 = SteadyTime{} + std::chrono::hours{1};

TEST(Notify, ReachesTheSocketOfTheManager) {
    const testing::TemporaryDirectory directory;
    NotifySocket socket(directory / "notify");
    ::setenv("NOTIFY_SOCKET", socket.path().c_str(), 1);
    SystemdNotifier notifier;
    notifier.send("READY=1");
    ::unsetenv("NOTIFY_SOCKET");
    EXPECT_EQ(socket.receive(), "READY=1");
    notifier.send("STOPPING=1");
    EXPECT_EQ(socket.receive(), "") << "nobody listens, nothing is sent, nothing fails";
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
    WatchdogFeed feed(seconds{8});
    int fed = 0;
    for (int ms = 0; ms < 8000; ms += 100)
        fed += feed.is_due(t0 + std::chrono::milliseconds{ms}, std::nullopt) ? 1 : 0;
    EXPECT_EQ(fed, 4);
}

TEST(Watchdog, IsNotFedWhileAJobIsStuck) {
    WatchdogFeed feed(seconds{8});
    EXPECT_TRUE(feed.is_due(t0, t0 - seconds{8}));
    EXPECT_FALSE(feed.is_due(t0 + seconds{3}, t0 - seconds{8})) << "11 s in one job";
    EXPECT_TRUE(feed.is_due(t0 + seconds{6}, std::nullopt)) << "it ended after all";
}

TEST(Watchdog, DoesNothingWhenThereIsNone) {
    WatchdogFeed feed(std::nullopt);
    EXPECT_FALSE(feed.is_due(t0, std::nullopt));
    EXPECT_FALSE(feed.next_time());
}

}  // namespace
}  // namespace stormcellar::daemon
