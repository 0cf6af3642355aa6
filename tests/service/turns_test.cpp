// Tests the main loop of a service: its passes (turns), reloads, the watchdog and the end.
#include "service/turns.h"

#include <csignal>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/service/fake_notifier.h"

namespace stormcellar {
namespace {

using ::testing::ElementsAre;
using ::testing::StartsWith;

// Sends signals before the loop begins, so that the loop takes one signal in each turn, SIGHUP
// first.
class Turns : public ::testing::Test {
  protected:
    bool take(std::initializer_list<int> signals) {
        for (const int signal : signals)
            ::pthread_kill(::pthread_self(), signal);
        return take_turns(service_, *signals_, notifier_);
    }

    const Result<Signals> signals_ = Signals::open();
    FakeNotifier notifier_;
    int turns_ = 0, reloads_ = 0;
    bool is_well_ = true, can_reload_ = true;
    const ServiceTurns service_{[this] { ++turns_; }, [this] { return is_well_; },
                                [this] {
                                    ++reloads_;
                                    return can_reload_;
                                }};
};

TEST_F(Turns, EndWithASignal) {
    for (const int signal : {SIGTERM, SIGINT}) {
        EXPECT_TRUE(take({signal})) << signal;
        EXPECT_EQ(reloads_, 0);
    }
    EXPECT_EQ(turns_, 2);
    EXPECT_THAT(notifier_.sent(), ElementsAre("READY=1", "STOPPING=1", "READY=1", "STOPPING=1"));
}

TEST_F(Turns, GoOnAfterAReload) {
    EXPECT_TRUE(take({SIGHUP, SIGTERM}));
    EXPECT_EQ(reloads_, 1);
    EXPECT_EQ(turns_, 2);
    EXPECT_THAT(notifier_.sent(),
                ElementsAre("READY=1", StartsWith("RELOADING=1\n"), "READY=1", "STOPPING=1"));
}

TEST_F(Turns, EndWithAReloadThatLeavesNoService) {
    can_reload_ = false;
    EXPECT_FALSE(take({SIGHUP}));
    EXPECT_EQ(turns_, 1);
}

TEST_F(Turns, FeedTheWatchdogOfAServiceThatIsWell) {
    notifier_.period = std::chrono::microseconds{1};
    is_well_ = false;
    EXPECT_TRUE(take({SIGTERM}));
    EXPECT_THAT(notifier_.sent(), ElementsAre("READY=1", "STOPPING=1"));
    is_well_ = true;
    EXPECT_TRUE(take({SIGTERM}));
    EXPECT_THAT(notifier_.sent(),
                ElementsAre("READY=1", "STOPPING=1", "READY=1", "WATCHDOG=1", "STOPPING=1"));
}

}  // namespace
}  // namespace stormcellar
