#include "daemon/care/cache_keeper.h"

#include <atomic>
#include <thread>

#include <gtest/gtest.h>

#include "tests/daemon/fake_sink.h"

namespace stormcellar::daemon {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

class RollingSink final : public Sink {
  public:
    Result<Taken> take(const std::filesystem::path&, bool, pipeline::Tries /*tries*/) override {
        return Taken{};
    }
    Result<int> mark_missing(const OnStep& /*step*/) override { return 0; }
    CacheRolled roll_cache(const cache::Budgets& budgets, const OnStep& /*step*/) override {
        while (hold)
            std::this_thread::sleep_for(milliseconds{1});
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
    // Polls at one time until the current roll has ended and was taken.
    std::optional<cache::StoreUsage> take(int rolls) {
        while (sink_.rolls < rolls)
            std::this_thread::sleep_for(milliseconds{1});
        std::optional<cache::StoreUsage> usage;
        for (int i = 0; i < 1000 && woken_ < rolls; ++i)
            std::this_thread::sleep_for(milliseconds{1});
        for (int i = 0; i < 100 && !usage; ++i) {
            usage = keeper_.poll(now_, budgets_);
            std::this_thread::sleep_for(milliseconds{1});
        }
        return usage;
    }
    RollingSink sink_;
    std::atomic<int> woken_{0};
    CacheKeeper keeper_{sink_, [this] { ++woken_; }};
    cache::Budgets budgets_;
    SteadyTime now_{seconds{100}};
};

TEST_F(CacheKeeperTest, RollsAtOnceThenEveryFiveSecondsAndTellsNews) {
    EXPECT_LE(CacheKeeper::period, seconds{10}) << "the percentage acts within 10 s";
    EXPECT_FALSE(keeper_.poll(now_, budgets_));
    EXPECT_EQ(keeper_.next_time(), now_ + CacheKeeper::period);
    const auto usage = take(1);
    ASSERT_TRUE(usage);
    EXPECT_EQ(usage->budget_bytes, std::nullopt);
    EXPECT_EQ(sink_.rolls, 1) << "not due again";

    budgets_.total.bytes = 7;
    now_ += CacheKeeper::period;
    keeper_.poll(now_, budgets_);
    EXPECT_EQ(take(2)->budget_bytes, 7U) << "a reload's budgets count";
    now_ += CacheKeeper::period;
    keeper_.poll(now_, budgets_);
    EXPECT_FALSE(take(3)) << "nothing new";
    now_ += CacheKeeper::period;
    sink_.grids = 3;
    keeper_.poll(now_, budgets_);
    EXPECT_EQ(take(4)->grids, 3U);
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
    EXPECT_TRUE(take(1));
}

}  // namespace
}  // namespace stormcellar::daemon
