#include "daemon/process/main_loop.h"

#include <csignal>

#include <gtest/gtest.h>

namespace stormcellar::daemon {
namespace {

// The signals stay blocked in this thread, as in the thread of the service.
TEST(TakeSignals, AreTakenOneAfterTheOther) {
    const Result<Signals> signals = Signals::open();
    ASSERT_TRUE(signals);
    int reloads = 0;
    const auto reload = [&] { ++reloads; };
    EXPECT_FALSE(take_signals(&*signals, reload)) << "no signal has come";
    ::pthread_kill(::pthread_self(), SIGHUP);
    EXPECT_FALSE(take_signals(&*signals, reload));
    EXPECT_EQ(reloads, 1);
    for (const int ending : {SIGTERM, SIGINT}) {
        ::pthread_kill(::pthread_self(), SIGHUP);
        ::pthread_kill(::pthread_self(), ending);
        EXPECT_TRUE(take_signals(&*signals, reload)) << ending;
        EXPECT_FALSE(take_signals(&*signals, reload)) << "the signals were already taken";
    }
    EXPECT_EQ(reloads, 3) << "a reload beside the ending signal is not lost";
    EXPECT_FALSE(take_signals(nullptr, reload));
}

}  // namespace
}  // namespace stormcellar::daemon
