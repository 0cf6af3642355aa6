// Tests the times of listings with a simulated clock.
#include "fetch/feed/poll_pace.h"

#include <vector>

#include <gtest/gtest.h>

namespace stormcellar::feed {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr milliseconds every{4000};

// Returns the largest number of these instants that are within one minute.
std::size_t most_a_minute(const std::vector<SteadyTime>& times) {
    std::size_t most = 0;
    for (std::size_t first = 0, last = 0; last < times.size(); ++last) {
        while (times[last] - times[first] >= seconds{60})
            ++first;
        most = std::max(most, last - first + 1);
    }
    return most;
}

TEST(PollPace, AnIdleStationIsAskedTwentyTimesAMinuteAtMost) {
    for (unsigned seed = 1; seed <= 20; ++seed) {
        PollPace pace(every, 20, seed);
        std::vector<SteadyTime> times;
        SteadyTime now = steady_now();
        for (int i = 0; i < 500; ++i) {
            times.push_back(now);
            pace.note_nothing(now);
            now += pace.pause(now, i % 3 == 0);  // a third of the answers are steps of a search
        }
        EXPECT_LE(most_a_minute(times), 20U);
        EXPECT_LT(most_a_minute({times.end() - 100, times.end()}), 10U)
            << "a silent station is asked rarely";
    }
}

TEST(PollPace, ASearchOfManyStepsIsHeldBackToo) {
    PollPace pace(every, 20, 1);
    std::vector<SteadyTime> times;
    SteadyTime now = steady_now();
    for (int i = 0; i < 300; ++i) {
        times.push_back(now);
        pace.note_nothing(now);
        now += pace.pause(now, true);
    }
    EXPECT_EQ(most_a_minute(times), 20U);
}

TEST(PollPace, WhileChunksComeThePauseIsThePollingInterval) {
    PollPace pace(every, 20, 1);
    const SteadyTime now = steady_now();
    for (int i = 0; i < 100; ++i) {
        pace.note_news(now, seconds{5});
        EXPECT_LE(pace.pause(now), every);
        EXPECT_GE(pace.pause(now), every * 9 / 10);
    }
    pace.note_news(now, seconds{12});
    EXPECT_LE(pace.pause(now), seconds{6});
    EXPECT_GT(pace.pause(now), seconds{5}) << "half of 12 s, minus the random part";
    pace.note_news(now, seconds{60});
    EXPECT_LE(pace.pause(now), 3 * every);
}

TEST(PollPace, AfterFailuresThePauseDoublesUpToAMinute) {
    PollPace pace(every, 20, 1);
    SteadyTime now = steady_now();
    seconds expected{1};
    for (int i = 0; i < 12; ++i) {
        pace.note_failure(now, {});
        const milliseconds pause = pace.pause(now);
        EXPECT_LE(pause, expected);
        EXPECT_GE(pause, expected * 9 / 10.0);
        expected = std::min(2 * expected, seconds{60});
        now += pause;
    }
    pace.note_news(now, {});
    pace.note_failure(now, seconds{30});
    EXPECT_GE(pace.pause(now), seconds{30}) << "the pause that the server requests";
    pace.note_failure(now, std::chrono::hours{5});
    EXPECT_EQ(pace.pause(now), seconds{60}) << "the pause is at most a minute";
    pace.note_news(now, {});
    EXPECT_LE(pace.pause(now), every);
}

}  // namespace
}  // namespace stormcellar::feed
