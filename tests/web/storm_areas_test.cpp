// Tests the choice of areas and grids from which storms are found.
#include "web/data/storms/storm_areas.h"

#include <gtest/gtest.h>

#include "tests/cache/made_grids.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::web {
namespace {

using namespace std::chrono_literals;
using testing::noon;

class StormAreas : public ::testing::Test {
  protected:
    void commit(const std::string& domain, int minutes) {
        ASSERT_TRUE(testing::commit_sized(store_, domain, noon + std::chrono::minutes{minutes}));
    }
    // Returns the areas with the number of their grids, or the error.
    [[nodiscard]] std::string areas(const StormQuery& query = {}) const {
        const auto found = storm_areas(*grids_, query);
        if (!found) return found.error().message;
        std::string text;
        for (const StormArea& area : *found)
            text += fmt::format("{} {};", area.name, area.times.size());
        return text;
    }
    testing::TemporaryDirectory directory_;
    cache::StoreWriter store_ =
        *cache::StoreWriter::open(real_file_system(), directory_ / "cache", false);
    std::shared_ptr<Grids> grids_ = *Grids::open({.cache = directory_ / "cache"});
};

TEST_F(StormAreas, AreStationsWithRecentGridsInOldCachesToo) {
    EXPECT_EQ(areas(), "");
    commit("KBGM", 0);
    commit("KOKX", 31);
    commit("KTLX", 1);
    EXPECT_EQ(areas(), "KOKX 1;KTLX 1;");
    EXPECT_EQ(areas({.at = noon + 20min}), "KBGM 1;KTLX 1;");
    EXPECT_EQ(areas({.at = noon}), "KBGM 1;");
    EXPECT_EQ(areas({.at = noon - 1s}), "");
    EXPECT_EQ(areas({.at = noon + 24h}), "");
}

TEST_F(StormAreas, AreDomainsIfThereAreAny) {
    commit("KBGM", 0);
    commit("northeast", 5);
    commit("northeast.KBGM", 5);  // a part of the mosaic
    EXPECT_EQ(areas(), "northeast 1;");
    EXPECT_EQ(areas({.at = noon}), "KBGM 1;") << "the mosaic came later";
    EXPECT_EQ(areas({.area = "KBGM"}), "KBGM 1;");
}

TEST_F(StormAreas, HaveTheGridsOfAnHour) {
    for (int minutes = -70; minutes <= 0; minutes += 2)
        commit("KBGM", minutes);
    const auto found = storm_areas(*grids_, {.area = "KBGM"});
    ASSERT_TRUE(found);
    ASSERT_EQ(found->front().times.size(), most_storm_grids);
    EXPECT_EQ(found->front().times.back(), noon) << "the newest are kept";
    EXPECT_EQ(areas({.area = "KBGM", .at = noon - 40min}), "KBGM 16;");
    EXPECT_EQ(areas({.area = "KBGM", .at = noon + 31min}), "KBGM 0;");
}

TEST_F(StormAreas, RefuseUnknownNamesAndTooManyStations) {
    EXPECT_EQ(areas({.area = "KOKX"}), "area: there is no grid of REF in 'KOKX'");
    EXPECT_EQ(areas({.area = "../KOKX"}), "area: there is no grid of REF in '../KOKX'");
    EXPECT_EQ(areas({.area = ""}), "area: there is no grid of REF in ''");
    for (char letter = 'A'; letter <= 'Z'; ++letter)
        commit(fmt::format("KA{0}{0}", letter), 0);
    for (char letter = 'A'; letter <= 'F'; ++letter)
        commit(fmt::format("KB{0}{0}", letter), 0);
    EXPECT_TRUE(areas().ends_with("KBFF 1;")) << areas();
    commit("KCCC", 0);
    EXPECT_EQ(areas(), "area: 33 areas have recent grids of REF; name one");
}

// A station whose clock is wrong must not hide the other stations.
TEST_F(StormAreas, IgnoreTimesOfTheFuture) {
    commit("KBGM", 0);
    ASSERT_TRUE(testing::commit_sized(store_, "KOKX", now_utc() + 24h));
    EXPECT_EQ(areas(), "KBGM 1;");
}

}  // namespace
}  // namespace stormcellar::web
