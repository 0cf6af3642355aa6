#include "cli/shared/interrupt.h"

#include <gtest/gtest.h>

namespace stormcellar::cli {
namespace {

TEST(Interrupt, FirstSignalOnlySetsTheFlag) {
    const Interrupt interrupt;
    EXPECT_FALSE(interrupt.flag());
    ::raise(SIGTERM);
    EXPECT_TRUE(interrupt.flag());
}

TEST(Interrupt, StartsAnewEachTime) {
    {
        const Interrupt interrupt;
        ::raise(SIGINT);
    }
    const Interrupt interrupt;
    EXPECT_FALSE(interrupt.flag());
}

TEST(InterruptDeathTest, SecondSignalEndsTheProgram) {
    EXPECT_EXIT(
        {
            const Interrupt interrupt;
            ::raise(SIGINT);
            ::raise(SIGINT);
        },
        ::testing::KilledBySignal(SIGINT), "");
}

TEST(InterruptDeathTest, EndsByTheSignalThatCame) {
    EXPECT_EXIT(
        {
            Interrupt interrupt;
            ::raise(SIGTERM);
            interrupt.end_by_signal();
        },
        ::testing::KilledBySignal(SIGTERM), "");
}

TEST(Interrupt, EndBySignalReturnsWhenNoneCame) {
    Interrupt interrupt;
    interrupt.end_by_signal();
    EXPECT_FALSE(interrupt.flag());
}

TEST(Interrupt, IgnoredSignalStaysIgnored) {
    ::signal(SIGHUP, SIG_IGN);
    {
        const Interrupt interrupt;
        ::raise(SIGHUP);
        EXPECT_FALSE(interrupt.flag());
    }
    ::raise(SIGHUP);
    ::signal(SIGHUP, SIG_DFL);
}

}  // namespace
}  // namespace stormcellar::cli
