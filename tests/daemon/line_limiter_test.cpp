#include "daemon/log/line_limiter.h"

#include <set>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/daemon/steady_start.h"

namespace stormcellar::daemon {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(RateLimit, LetsSoManyThroughAndCountsTheRest) {
    RateLimit limit(3, seconds{10});
    int allowed = 0;
    for (int i = 0; i < 100; ++i)
        allowed += limit.allow(t0) ? 1 : 0;
    EXPECT_EQ(allowed, 3);
    EXPECT_FALSE(limit.is_idle(t0 + seconds{60}));
    EXPECT_FALSE(limit.take_held_back(t0 + seconds{9})) << "the period is not over";
    EXPECT_EQ(limit.take_held_back(t0 + seconds{10}), 97U);
    EXPECT_FALSE(limit.take_held_back(t0 + seconds{10}));
    EXPECT_TRUE(limit.is_idle(t0 + seconds{10}));
    EXPECT_TRUE(limit.allow(t0 + seconds{10}));
    EXPECT_FALSE(limit.is_idle(t0 + seconds{11}));
}

TEST(RateLimit, ASlowTrickleIsNeverHeldBack) {
    RateLimit limit(1, seconds{10});
    for (int i = 0; i < 5; ++i)
        EXPECT_TRUE(limit.allow(t0 + i * seconds{10}));
    EXPECT_FALSE(limit.take_held_back(t0 + seconds{1000}));
}

int allowed_of(LineLimiter& limiter, Event event, const std::string& subject, int lines,
               SteadyTime now) {
    int allowed = 0;
    for (int i = 0; i < lines; ++i)
        allowed += limiter.allow(event, subject, LogLevel::warning, now) ? 1 : 0;
    return allowed;
}

TEST(LineLimiter, AFloodOfOneStationLeavesTheOthersAlone) {
    LineLimiter limiter;
    EXPECT_EQ(allowed_of(limiter, Event::rejected, "KTLX", 1254, t0), 20);
    EXPECT_EQ(allowed_of(limiter, Event::rejected, "KBGM", 5, t0), 5);
    EXPECT_EQ(allowed_of(limiter, Event::no_moment, "KTLX", 5, t0), 5)
        << "another kind of event has its own limit";
    EXPECT_TRUE(limiter.take_held_back(t0 + milliseconds{59'999}).empty());
    const auto held = limiter.take_held_back(t0 + seconds{60});
    ASSERT_EQ(held.size(), 1U);
    EXPECT_EQ(held[0].event, Event::rejected);
    EXPECT_EQ(held[0].subject, "KTLX");
    EXPECT_EQ(held[0].level, LogLevel::warning);
    EXPECT_EQ(held[0].lines, 1234U);
    EXPECT_TRUE(limiter.take_held_back(t0 + seconds{61}).empty()) << "the count is reported once";
    EXPECT_EQ(allowed_of(limiter, Event::rejected, "KTLX", 30, t0 + seconds{62}), 20)
        << "a new minute has begun";
}

// A feed can use any names. 100,000 names must not cause more lines or take more memory than a few
// names. The test simulates an hour, with a line of each name once a minute.
TEST(LineLimiter, AFloodOfManyStationsIsHeldToo) {
    LineLimiter limiter;
    std::uint64_t written = 0;
    std::uint64_t held_back = 0;
    const int minutes = 60;
    const int a_minute = 2000;
    for (int minute = 0; minute < minutes; ++minute) {
        const SteadyTime now = t0 + minute * seconds{60};
        for (const LineLimiter::HeldBack& held : limiter.take_held_back(now)) {
            held_back += held.lines;
            ++written;
        }
        for (int i = 0; i < a_minute; ++i) {
            written += allowed_of(limiter, Event::rejected,
                                  fmt::format("{}", minute * a_minute + i), 1, now);
        }
        EXPECT_LE(limiter.subjects(), LineLimiter::most_subjects);
    }
    for (const LineLimiter::HeldBack& held : limiter.take_held_back(t0 + minutes * seconds{60})) {
        held_back += held.lines;
        ++written;
    }
    EXPECT_LE(written, minutes * (120U + 2U));
    EXPECT_GE(written, minutes * 120U);
    const std::uint64_t shown = minutes * 120U;
    EXPECT_EQ(held_back, minutes * a_minute - shown)
        << "every line that is not shown must be counted";
}

// 2026-11-25: once invented names had filled the table, all other stations shared one limit.
TEST(LineLimiter, InventedSubjectsTakeNoLinesFromOthers) {
    LineLimiter limiter;
    for (std::size_t i = 0; i < 2 * LineLimiter::most_subjects; ++i)
        (void)limiter.allow(Event::rejected, fmt::format("{}", i), LogLevel::warning, t0);
    for (const char* station : {"KTLX", "KINX", "KVNX"})
        EXPECT_EQ(allowed_of(limiter, Event::gridded, station, 60, t0), 60) << station;
    EXPECT_EQ(limiter.subjects(), LineLimiter::most_subjects);
}

TEST(LineLimiter, TheGravestOfWhatIsHeldBackCounts) {
    LineLimiter limiter;
    for (int i = 0; i < 30; ++i) {
        (void)limiter.allow(Event::loop_said, "a", i == 25 ? LogLevel::warning : LogLevel::info,
                            t0);
    }
    const auto held = limiter.take_held_back(t0 + seconds{60});
    ASSERT_EQ(held.size(), 1U);
    EXPECT_EQ(held[0].level, LogLevel::warning);
}

// Simulates the heaviest possible feed: 160 sites send a volume every four minutes each, and one
// site has a backlog.
TEST(LineLimiter, AFeedAsItShouldBeIsNotHeldBack) {
    LineLimiter limiter;
    for (int second = 0; second < 3600; ++second) {
        const SteadyTime now = t0 + seconds{second};
        EXPECT_TRUE(limiter.take_held_back(now).empty());
        for (int site = 0; site < 160; ++site) {
            if ((second + site) % 240 != 0) continue;
            EXPECT_TRUE(
                limiter.allow(Event::gridded, fmt::format("K{}", site), LogLevel::info, now));
        }
    }
}

TEST(LogEvent, EachHasANameOfItsOwn) {
    std::set<std::string_view> names;
    for (std::size_t i = 0; i < event_count; ++i) {
        const std::string_view name = name_of(static_cast<Event>(i));
        EXPECT_FALSE(name.empty());
        EXPECT_EQ(name.find_first_not_of("abcdefghijklmnopqrstuvwxyz_"), std::string_view::npos);
        EXPECT_TRUE(names.insert(name).second) << name;
    }
    EXPECT_EQ(name_of(Event::ready), "ready");
    EXPECT_EQ(name_of(Event::overflow), "overflow");
    EXPECT_EQ(name_of(Event::status_unwritten), "status_unwritten");
}

}  // namespace
}  // namespace stormcellar::daemon
