// Tests that the budget of bytes is never exceeded, by adding up the files after every operation on
// the disk.
#include <atomic>
#include <random>
#include <thread>

#include <gtest/gtest.h>

#include "cache/evict.h"
#include "cache/pins.h"
#include "stormcellar/cache/store.h"
#include "tests/cache/made_grids.h"
#include "tests/testing/metered_file_system.h"
#include "tests/testing/slow_down.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::cache {
namespace {

namespace fs = std::filesystem;
using std::chrono::minutes;
using testing::noon;

constexpr std::uint64_t total = 600'000;
constexpr std::uint64_t of_b = 250'000;

// Returns the factor by which STORMCELLAR_LONG makes the tests longer; by default 1.
int times_longer() {
    const char* text = std::getenv("STORMCELLAR_LONG");
    return text == nullptr ? 1 : std::max(1, std::atoi(text));
}

struct Counts {
    std::atomic<int> committed{0}, not_kept{0}, refused{0};
};

// Commits grids of all sizes at times that mostly advance, commits late grids, replaces and pins
// grids, rolls, and evicts on request.
void live(RollingStore& store, FileSystem& disk, std::uint64_t seed, int steps, Counts& counts) {
    std::mt19937_64 random(seed);
    const auto draw = [&](int end) {
        return static_cast<int>(random() % static_cast<std::uint64_t>(end));
    };
    const std::vector<std::string> domains = {"A", "B", "B.KBOX", "C"};
    for (int step = 0; step < steps; ++step) {
        const std::string& domain = domains.at(static_cast<std::size_t>(draw(4)));
        const UtcTime time = noon + minutes{step / 2 - (draw(4) == 0 ? draw(30) : 0)};
        const int what = draw(20);
        if (what == 0) {
            store.roll();
        } else if (what == 1) {
            const auto path = store.path_of(domain, level2::Moment::ref, time);
            (void)(draw(4) == 0 ? pin_grid(disk, *path)
                                : Status(unpin_grid(disk, *path).map([](bool) {})));
        } else if (what == 2) {
            const auto plan = plan_eviction(store, {domain, {}, of_b / 2, {}}, noon);
            if (plan) (void)evict(disk, plan->victims);
        } else {
            const auto path = testing::commit_sized(store, domain, time, 1 + draw(8), step);
            if (!path) {
                EXPECT_EQ(path.error().code, ErrorCode::over_budget) << path.error().message;
                ++counts.refused;
            } else {
                ++(path->empty() ? counts.not_kept : counts.committed);
            }
        }
    }
}

class RollingBudgetTest : public ::testing::TestWithParam<int> {
  protected:
    void run(int threads) {
        Budgets budgets;
        budgets.total.bytes = total;
        budgets.domains["B"].bytes = of_b;
        budgets.low_watermark = 0.8;
        RollingStore store = *RollingStore::open(disk_, cache_, budgets);
        const int steps = 240 * times_longer() / testing::slow_down / threads;
        std::vector<std::thread> workers;
        for (int i = 0; i < threads; ++i) {
            const int seed = 100 * threads + i;
            workers.emplace_back([&, seed] {
                live(store, disk_, static_cast<std::uint64_t>(seed), steps, counts_);
            });
        }
        for (auto& worker : workers)
            worker.join();
        check(store);
    }
    void check(RollingStore& store) {
        EXPECT_LE(disk_.most(), total);
        EXPECT_GT(disk_.most(), total / 2) << "the cache never came near its budget";
        EXPECT_GT(disk_.removals(), 0U);
        EXPECT_GT(counts_.committed, 0);
        for (const StoreEntry& entry : testing::all_grids(store))
            EXPECT_EQ(testing::trouble_in(entry), "");
        store.roll();
        EXPECT_EQ(store.usage().bytes, testing::allocated_bytes(cache_));
        EXPECT_EQ(store.usage().grids, testing::all_grids(store).size());
        EXPECT_LE(
            testing::allocated_bytes(cache_ / "B") + testing::allocated_bytes(cache_ / "B.KBOX"),
            of_b);
    }
    testing::TemporaryDirectory directory_;
    fs::path cache_ = directory_ / "cache";
    testing::MeteredFileSystem disk_{cache_};
    Counts counts_;
};

TEST_P(RollingBudgetTest, IsNeverExceededAtAnyInstant) {
    run(GetParam());
}

INSTANTIATE_TEST_SUITE_P(Threads, RollingBudgetTest, ::testing::Values(1, 2, 4));

// The reserved bound holds for every size, and is close to the true size.
TEST(MostBytesOnDisk, BoundsWhatAFileTakes) {
    const testing::TemporaryDirectory directory;
    for (int stored = 1; stored <= testing::most_bricks; ++stored) {
        const auto about = testing::sized_description(noon);
        const auto view = testing::sized_grid(stored).view();
        const auto written = write_grid_file(real_file_system(), directory / "a.scg", about, view);
        ASSERT_TRUE(written);
        const std::uint64_t most = most_bytes_on_disk(about, view, 4096);
        EXPECT_LE(*written, most);
        EXPECT_LE(most, *written + *written / 32 + 8 * 4096);
        EXPECT_GE(most_bytes_on_disk(about, view, 65536), most);
    }
}

}  // namespace
}  // namespace stormcellar::cache
