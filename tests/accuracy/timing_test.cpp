#include "accuracy/timing.h"

#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace stormcellar::accuracy {
namespace {

// Each piece of work advances the test's own clock by the next time in its list.
TEST(Timing, FirstLeastAndMedianOfRuns) {
    double clock_s = 0;
    const auto now_s = [&] { return clock_s; };
    const std::vector<double> durations = {9, 3, 1, 2, 5};
    std::size_t run = 0;
    const std::vector<std::function<void()>> works = {[&] { clock_s += durations[run++]; }};
    const auto timings = time_in_rounds(works, 5, now_s);
    ASSERT_EQ(timings.size(), 1U);
    EXPECT_EQ(timings[0].first_s, 9);
    EXPECT_EQ(timings[0].least_s, 1);
    EXPECT_EQ(timings[0].median_s, 2.5);  // of 1, 2, 3, 5

    run = 0;
    const auto once = time_in_rounds(works, 0, now_s);
    EXPECT_EQ(run, 1U);
    EXPECT_EQ(once[0].first_s, 9);
    EXPECT_EQ(once[0].least_s, 9);
    EXPECT_EQ(once[0].median_s, 9);

    run = 0;
    EXPECT_EQ(time_in_rounds(works, 4, now_s)[0].median_s, 2);  // of 1, 2, 3
}

TEST(Timing, RoundsTurnRoundSoThatNoneIsAlwaysBehindTheSame) {
    std::string order;
    const std::vector<std::function<void()>> works = {[&] { order += 'a'; }, [&] { order += 'b'; },
                                                      [&] { order += 'c'; }};
    EXPECT_EQ(time_in_rounds(works, 3).size(), 3U);
    EXPECT_EQ(order, "abccbaabc");
}

TEST(Timing, ASlowerMachineIsSharedByAll) {
    // The machine becomes twice as slow in the third round and three times as slow in the fifth.
    // The timings must still show which work is slower.
    double clock_s = 0;
    int runs = 0;
    const auto work = [&](double cost_s) {
        return [&clock_s, &runs, cost_s] {
            const int round = runs++ / 4;
            clock_s += cost_s * (1 + round);
        };
    };
    const std::vector<std::function<void()>> works = {work(1), work(2)};
    const auto timings = time_in_rounds(works, 5, [&] { return clock_s; });
    EXPECT_EQ(timings[1].least_s, 2 * timings[0].least_s);
    EXPECT_EQ(timings[1].first_s, 2 * timings[0].first_s);
}

TEST(Timing, AThreadsSecondsAreThoseItWorks) {
    constexpr double work_s = 0.1;
    const double start_s = thread_s();
    std::thread([] {
        const double before_s = thread_s();
        while (thread_s() - before_s < work_s) {
        }
    }).join();
    EXPECT_LT(thread_s() - start_s, work_s) << "waiting for a thread takes no time";
    double last_s = start_s;
    while (last_s - start_s < work_s) {
        const double now_s = thread_s();
        ASSERT_GE(now_s, last_s);
        last_s = now_s;
    }
}

TEST(Timing, TheClockNeverRunsBack) {
    double before = monotonic_s();
    for (int i = 0; i < 1000; ++i) {
        const double now = monotonic_s();
        EXPECT_GE(now, before);
        before = now;
    }
    EXPECT_TRUE(time_in_rounds({}, 3).empty());
}

}  // namespace
}  // namespace stormcellar::accuracy
