#include "cache/evict.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cache/pins.h"
#include "tests/cache/made_grids.h"
#include "tests/testing/metered_file_system.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::cache {
namespace {

namespace fs = std::filesystem;
using std::chrono::minutes;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::noon;
using testing::short_names;

class EvictTest : public ::testing::Test {
  protected:
    EvictTest() {
        for (int minute = 0; minute < 4; ++minute)
            EXPECT_TRUE(testing::commit_sized(store_, "A", noon + minutes{10 * minute}));
        EXPECT_TRUE(testing::commit_sized(store_, "B", noon + minutes{5}));
        EXPECT_TRUE(testing::commit_sized(store_, "B.KBOX", noon + minutes{15}));
        grid_bytes_ = testing::all_grids(store_).front().bytes_on_disk;
    }
    [[nodiscard]] EvictionPlan plan(const EvictionOrder& order) const {
        return *plan_eviction(store_, order, noon + std::chrono::hours{1});
    }
    testing::TemporaryDirectory directory_;
    testing::MeteredFileSystem disk_{directory_.path()};
    StoreWriter store_ = *StoreWriter::open(disk_, directory_.path(), false);
    std::uint64_t grid_bytes_ = 0;
};

TEST_F(EvictTest, ByTimeTakesAllUpToItTheNewestToo) {
    EXPECT_THAT(short_names(plan({"", noon + minutes{10}, {}, {}}).victims),
                ElementsAre("A+0", "B+5", "A+10"));
    EXPECT_THAT(short_names(plan({"A", noon + minutes{100}, {}, {}}).victims),
                ElementsAre("A+0", "A+10", "A+20", "A+30"));
    const auto of_b = plan({"B", noon + minutes{100}, {}, {}});
    EXPECT_THAT(short_names(of_b.victims), ElementsAre("B+5", "B.KBOX+15"));
    EXPECT_EQ(of_b.looked_at, 2U);
    EXPECT_THAT(short_names(plan({"B.KBOX", noon + minutes{100}, {}, {}}).victims),
                ElementsAre("B.KBOX+15"));
    EXPECT_EQ(plan({"C", noon, {}, {}}).looked_at, 0U);
}

TEST_F(EvictTest, ByBytesKeepsTheNewestOfEachDomain) {
    const auto some = plan({"", {}, 4 * grid_bytes_, {}});
    EXPECT_THAT(short_names(some.victims), ElementsAre("A+0", "A+10"));
    EXPECT_EQ(some.bytes_left, 4 * grid_bytes_);
    const auto most = plan({"", {}, 0, {}});
    EXPECT_THAT(short_names(most.victims), ElementsAre("A+0", "A+10", "A+20"));
    EXPECT_EQ(most.bytes_left, 3 * grid_bytes_);
}

TEST_F(EvictTest, ByBytesTakesFirstWhatIsOfStationsThatNobodyKnows) {
    ASSERT_TRUE(testing::commit_sized(store_, "XAAA", noon + minutes{50}));
    ASSERT_TRUE(testing::commit_sized(store_, "KTLX", noon - minutes{50}));
    EXPECT_THAT(short_names(plan({"", {}, 7 * grid_bytes_, {}}).victims), ElementsAre("XAAA+50"));
    EXPECT_THAT(short_names(plan({"", {}, 0, {}}).victims),
                ElementsAre("A+0", "A+10", "A+20", "XAAA+50"));
}

TEST_F(EvictTest, ByAgeCountsFromEachDomainsNewest) {
    EXPECT_THAT(short_names(plan({"", {}, {}, minutes{15}}).victims), ElementsAre("A+0", "A+10"));
    EXPECT_THAT(short_names(plan({"B", {}, {}, minutes{5}}).victims), IsEmpty());
}

TEST_F(EvictTest, WhatIsAskedForInSeveralWaysAddsUp) {
    EXPECT_THAT(short_names(plan({"", noon, 4 * grid_bytes_, minutes{25}}).victims),
                ElementsAre("A+0", "A+10"));
}

TEST_F(EvictTest, RemovesWhatWasPlannedButWhatIsPinnedOrGoneByThen) {
    const auto planned = plan({"", noon + minutes{20}, {}, {}});
    ASSERT_EQ(planned.victims.size(), 5U);
    ASSERT_TRUE(pin_grid(disk_, planned.victims[0].path));
    fs::remove(planned.victims[1].path);
    const EvictionReport report = evict(disk_, planned.victims);
    EXPECT_THAT(short_names(report.evicted), ElementsAre("A+10", "B.KBOX+15", "A+20"));
    EXPECT_THAT(report.problems, IsEmpty());
    EXPECT_THAT(short_names(testing::all_grids(store_)), ElementsAre("A+0", "A+30"));
    EXPECT_FALSE(fs::exists(directory_ / "B.KBOX")) << "empty directories are removed";
    const auto after = plan({"", noon + minutes{100}, {}, {}});
    EXPECT_EQ(after.pinned, 1U);
    EXPECT_THAT(short_names(after.victims), ElementsAre("A+30"));
}

}  // namespace
}  // namespace stormcellar::cache
