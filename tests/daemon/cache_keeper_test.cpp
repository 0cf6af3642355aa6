#include "daemon/care/cache_keeper.h"

#include <atomic>

#include <gtest/gtest.h>

#include "tests/daemon/fake_sink.h"
#include "tests/testing/waiting.h"

namespace stormcellar::daemon {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

class RollingSink final : public IdleSink {
  public:
    CacheRolled roll_cache(const cache::Budgets& budgets, const OnStep& /*step*/) override {
        EXPECT_TRUE(testing::eventually([this] { return !hold; }));
        ++rolls;
        CacheRolled rolled;
        rolled.usage.emplace();
        rolled.usage->grids = grids;
        rolled.usage->budget_bytes = budgets.total.bytes;
        return rolled;
    }
    std::atomic<int> rolls{0}, grids{0};
    std::atomic<bool> hold{false};
};

class CacheKeeperTest : public ::testing::Test {
  protected:
    [[nodiscard]] bool has_ended(int rolls) const {
        return testing::eventually([&] { return woken_ >= rolls; });
    }
    // Advances the clock by `later` and polls, until a poll returns the usage of a roll.
    std::optional<cache::StoreUsage> next_news(seconds later = {}) {
        std::optional<cache::StoreUsage> usage;
        (void)testing::eventually([&] {
            now_ += later;
            return (usage = keeper_.poll(now_, budgets_)).has_value();
        });
        return usage;
    }
    RollingSink sink_;
    std::atomic<int> woken_{0};
    CacheKeeper keeper_{sink_, [this] { ++woken_; }};
    cache::Budgets budgets_;
    SteadyTime now_{seconds{100}};
};

TEST_F(CacheKeeperTest, RollsAtOnceThenEveryFiveSecondsAndTellsNews) {
    static_assert(CacheKeeper::period <= seconds{10}, "the percentage acts within 10 s");
    const SteadyTime began = now_;
    EXPECT_FALSE(keeper_.poll(now_, budgets_));
    EXPECT_EQ(keeper_.next_time(), began + CacheKeeper::period);
    ASSERT_TRUE(has_ended(1));
    auto usage = next_news();
    ASSERT_TRUE(usage);
    EXPECT_EQ(usage->budget_bytes, std::nullopt);
    EXPECT_FALSE(keeper_.poll(began + CacheKeeper::period - milliseconds{1}, budgets_));
    EXPECT_EQ(keeper_.next_time(), began + CacheKeeper::period)
        << "the next roll is due only after a period";

    budgets_.total.bytes = 7;
    now_ += CacheKeeper::period;
    keeper_.poll(now_, budgets_);
    usage = next_news();
    ASSERT_TRUE(usage);
    EXPECT_EQ(usage->budget_bytes, 7U) << "the roll uses the budgets of the reload";
    now_ += CacheKeeper::period;
    EXPECT_FALSE(keeper_.poll(now_, budgets_));
    ASSERT_TRUE(has_ended(3));
    sink_.grids = 3;
    usage = next_news(seconds{1});
    ASSERT_TRUE(usage);
    EXPECT_EQ(usage->grids, 3U) << "the previous roll found no change";
}

TEST_F(CacheKeeperTest, ALongRollHoldsNobodyUpAndRunsOnce) {
    sink_.hold = true;
    for (int i = 0; i < 10; ++i) {
        EXPECT_FALSE(keeper_.poll(now_, budgets_));
        EXPECT_GT(keeper_.next_time(), now_);
        now_ += CacheKeeper::period;
    }
    EXPECT_EQ(sink_.rolls, 0);
    sink_.hold = false;
    EXPECT_TRUE(has_ended(1));
    EXPECT_TRUE(next_news());
}

}  // namespace
}  // namespace stormcellar::daemon
