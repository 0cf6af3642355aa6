#include "daemon/log.h"

#include <cstdlib>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

namespace stormcellar::daemon {
namespace {

using std::chrono::seconds;

const SteadyTime t0 = SteadyTime{} + std::chrono::hours{1};

TEST(RateLimit, LetsSoManyThroughAndCountsTheRest) {
    RateLimit limit(3, seconds{10});
    int allowed = 0;
    for (int i = 0; i < 100; ++i)
        allowed += limit.allow(t0) ? 1 : 0;
    EXPECT_EQ(allowed, 3);
    EXPECT_FALSE(limit.take_held_back(t0 + seconds{9})) << "the period is not over";
    EXPECT_EQ(limit.take_held_back(t0 + seconds{10}), 97U);
    EXPECT_FALSE(limit.take_held_back(t0 + seconds{10}));
    EXPECT_TRUE(limit.allow(t0 + seconds{10}));
}

TEST(RateLimit, ASlowTrickleIsNeverHeldBack) {
    RateLimit limit(1, seconds{10});
    for (int i = 0; i < 5; ++i)
        EXPECT_TRUE(limit.allow(t0 + i * seconds{10}));
    EXPECT_FALSE(limit.take_held_back(t0 + seconds{1000}));
}

TEST(Journal, IsRecognisedByTheStreamThatItNames) {
    struct stat facts {};
    ASSERT_EQ(::fstat(STDERR_FILENO, &facts), 0);
    ::setenv("JOURNAL_STREAM", fmt::format("{}:{}", facts.st_dev, facts.st_ino).c_str(), 1);
    EXPECT_TRUE(stderr_is_journal());
    ::setenv("JOURNAL_STREAM", fmt::format("{}:{}", facts.st_dev, facts.st_ino + 1).c_str(), 1);
    EXPECT_FALSE(stderr_is_journal());
    ::unsetenv("JOURNAL_STREAM");
    EXPECT_FALSE(stderr_is_journal());
}

}  // namespace
}  // namespace stormcellar::daemon
