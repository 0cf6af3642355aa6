// Tests that the floating-point traps of scripts/test --traps fire, also in workers, and can be
// masked.
#include "tests/testing/fp_traps.h"

#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <limits>

#include <gtest/gtest.h>

#include "base/floating_point.h"
#include "base/parallel.h"

namespace stormcellar::testing {
namespace {

// volatile, so that the compiler does not know the values
volatile double zero = 0;
volatile double huge = 1e308;
volatile double nan_value = std::numeric_limits<double>::quiet_NaN();

template <class Operation>
void trapped(Operation operation) {
    std::signal(SIGFPE, SIG_DFL);  // sanitizers have their own handler
    const FpTraps traps;
    operation();
    std::_Exit(0);
}

void keep(double value) {
    [[maybe_unused]] volatile double kept = value;
}

TEST(FpTrapsDeathTest, WhatIsNoNumberEndsTheProgram) {
    const auto by_signal = ::testing::KilledBySignal(SIGFPE);
    EXPECT_EXIT(trapped([] { keep(1 / zero); }), by_signal, "");
    EXPECT_EXIT(trapped([] { keep(zero / zero); }), by_signal, "");
    EXPECT_EXIT(trapped([] { keep(huge * huge); }), by_signal, "");
    EXPECT_EXIT(trapped([] { keep(std::log10(zero)); }), by_signal, "");
}

TEST(FpTrapsDeathTest, AComparisonWithWhatIsNoNumberEndsTheProgram) {
#if defined(__clang__)
    GTEST_SKIP() << "clang compares by an instruction that raises no trap";
#else
    EXPECT_EXIT(trapped([] { keep(nan_value < zero ? 1 : 2); }), ::testing::KilledBySignal(SIGFPE),
                "");
#endif
}

TEST(FpTrapsDeathTest, OrdinaryArithmeticDoesNot) {
    const auto well = ::testing::ExitedWithCode(0);
    EXPECT_EXIT(trapped([] { keep(1 / huge / huge); }), well, "") << "underflow is not trapped";
    EXPECT_EXIT(trapped([] { keep(std::sqrt(zero + 2)); }), well, "")
        << "inexact results are not trapped";
    EXPECT_EXIT(trapped([] { keep(std::isnan(nan_value) ? 1 : 2); }), well, "");
    EXPECT_EXIT(trapped([] {
                    const MaskedTraps masked;
                    keep(1 / zero);
                }),
                well, "");
}

// There is one piece of work for each thread. Each piece waits for the other pieces, so that the
// caller cannot do all of them.
TEST(FpTrapsDeathTest, WorkersInheritThem) {
    const auto all_on = [] {
        std::atomic<int> begun{0};
        std::atomic<int> on{0};
        for_each_piece(4, 4, [&](int) {
            ++begun;
            while (begun < 4) {
            }
            on += fp_traps_are_on() ? 1 : 0;
        });
        std::_Exit(on == 4 ? 0 : 1);
    };
    EXPECT_EXIT(trapped(all_on), ::testing::ExitedWithCode(0), "");
}

TEST(FpTraps, AreAsBeforeAfterwards) {
    const bool before = fp_traps_are_on();
    {
        const FpTraps on;
        EXPECT_TRUE(fp_traps_are_on());
        {
            const MaskedTraps masked;
            EXPECT_FALSE(fp_traps_are_on());
        }
        EXPECT_TRUE(fp_traps_are_on());
    }
    EXPECT_EQ(fp_traps_are_on(), before);
}

}  // namespace
}  // namespace stormcellar::testing
