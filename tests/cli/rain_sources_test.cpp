// Tests rain totals of some hours: from cached grids of steady rain, whose total is known, and from
// real volumes.
#include "cli/picture/rain_sources.h"

#include <chrono>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/options/scene_options.h"
#include "stormcellar/retrieve/rain_rate.h"
#include "tests/cli/uniform_grid.h"
#include "tests/testing/data.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::cli {
namespace {

using grid::CellStatus;
using ::testing::Contains;
using ::testing::HasSubstr;

constexpr float steady_dbz = 40;
constexpr UtcTime steady_start{std::chrono::sys_days{std::chrono::year{2005} / 8 / 22}};

// A cache that has grids of steady rain of 40 dBZ, every five minutes for two hours.
class RainSources : public ::testing::Test {
  protected:
    void SetUp() override {
        for (int minute = 0; minute <= 120; minute += 5)
            commit(minute, level2::Moment::ref, steady_dbz);
    }
    void commit(int minute, level2::Moment moment, float value) {
        grid::Grid grid = testing::uniform_grid("20050822_000000", value);
        grid.moment = moment;
        grid.time = grid.start_time = grid.end_time = steady_start + std::chrono::minutes(minute);
        (void)testing::commit_grid(writer_, grid);
    }
    [[nodiscard]] Result<PictureGrid> total(const RainChoice& choice) const {
        return rain_total_of_domain(writer_, "KBGM", choice);
    }
    static std::string rain_of(const PictureGrid& grid) {
        return render::frame_facts_of("KBGM", grid.description(), "UTC").rain;
    }

    testing::TemporaryDirectory directory_;
    cache::StoreWriter writer_ =
        *cache::StoreWriter::open(real_file_system(), directory_ / "cache", true);
    const double mm_per_h_ =
        retrieve::rain_by_reflectivity_mm_per_h(static_cast<double>(steady_dbz));
};

TEST_F(RainSources, AnHourOfADomainEndsWithItsNewestGrid) {
    const auto made = total({.hours = 1});
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_EQ(made->description().time, steady_start + std::chrono::hours(2));
    EXPECT_EQ(made->description().start_time, steady_start + std::chrono::hours(1));
    EXPECT_EQ(made->description().moment, level2::Moment::rate);
    const grid::Grid rain = grid::to_dense(made->view());
    for (std::size_t column = 0; column < rain.values.size(); ++column) {
        ASSERT_EQ(rain.status[column], CellStatus::value);
        ASSERT_NEAR(rain.values[column], mm_per_h_, 0.02);
    }
    EXPECT_EQ(rain_of(*made), "60 minutes");
    EXPECT_THAT(made->description().provenance.notes, Contains(HasSubstr("reflectivity alone")));
}

TEST_F(RainSources, MinutesBeforeTheFirstGridAreCountedAndNeverTakenAsDry) {
    const auto made = total({.hours = 3});
    ASSERT_TRUE(made);
    EXPECT_EQ(rain_of(*made), "180 minutes, 60 of them without volumes");
    const grid::Grid rain = grid::to_dense(made->view());
    EXPECT_EQ(rain.status.front(), CellStatus::ambiguous) << "a third of the time was not seen";
    const auto most = total({.hours = 2.2});
    ASSERT_TRUE(most);
    EXPECT_EQ(rain_of(*most), "132 minutes, 12 of them without volumes");
    const grid::Grid sum = grid::to_dense(most->view());
    EXPECT_EQ(sum.status.front(), CellStatus::value) << "less than a tenth was not seen";
    EXPECT_NEAR(sum.values.front(), 2 * mm_per_h_, 0.05) << "only the minutes that were seen";
}

TEST_F(RainSources, TheTimeOfTheEndMayBeBetweenGrids) {
    const auto end = steady_start + std::chrono::minutes(92);
    const auto made = total({.hours = 1, .until = end});
    ASSERT_TRUE(made);
    EXPECT_EQ(made->description().time, end);
    EXPECT_EQ(rain_of(*made), "60 minutes");
    EXPECT_NEAR(grid::to_dense(made->view()).values.front(), mm_per_h_, 0.02);
}

TEST_F(RainSources, AMosaicOfTheCacheHasATotal) {
    for (int minute = 0; minute <= 60; minute += 5) {
        grid::Grid grid = testing::uniform_grid("20050822_000000", steady_dbz);
        grid.time = steady_start + std::chrono::minutes(minute);
        grid.start_time = grid.time - std::chrono::minutes(5);  // of the oldest of its volumes
        grid.end_time = grid.time + std::chrono::minutes(1);
        grid.provenance.recipe = 7;
        // A radar may be silent for a while.
        if (minute >= 20) grid.sites.push_back({"KENX", 42.6, -74.1, 580});
        const auto bricks = grid::BrickGrid::from(grid, grid::default_quantization(grid.moment));
        ASSERT_TRUE(writer_.commit("northeast", cache::describe(grid), bricks.view()));
    }
    const auto made = rain_total_of_domain(writer_, "northeast", {.hours = 1});
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_EQ(rain_of(*made), "60 minutes");
    EXPECT_EQ(made->description().time, steady_start + std::chrono::hours(1))
        << "the time of the frame";
    EXPECT_NEAR(grid::to_dense(made->view()).values.front(), mm_per_h_, 0.02);
}

TEST_F(RainSources, GridsOfRateComeFirst) {
    for (int minute = 60; minute <= 120; minute += 10)
        commit(minute, level2::Moment::rate, 30);
    const auto made = total({.hours = 1});
    ASSERT_TRUE(made);
    EXPECT_NEAR(grid::to_dense(made->view()).values.front(), 30, 0.02);
    EXPECT_THAT(made->description().provenance.notes,
                Not(Contains(HasSubstr("reflectivity alone"))));
}

TEST_F(RainSources, GridsWithOtherCellsAreNotSeen) {
    grid::Grid other = testing::uniform_grid("20050822_000000", steady_dbz, 20);
    other.time = other.start_time = other.end_time = steady_start + std::chrono::minutes(125);
    (void)testing::commit_grid(writer_, other);
    EXPECT_EQ(total({.hours = 1}).error().message, "a rain total needs at least two volumes");
}

TEST_F(RainSources, RefusesHoursOutOfRangeAndDomainsWithoutGrids) {
    for (const double hours : {0.0, -1.0, 24.1, std::numeric_limits<double>::quiet_NaN()}) {
        const auto refused = total({.hours = hours});
        ASSERT_FALSE(refused) << hours;
        EXPECT_EQ(refused.error().code, ErrorCode::bad_argument);
    }
    EXPECT_TRUE(total({.hours = 24}));
    const auto none = rain_total_of_domain(writer_, "KFDR", {.hours = 1});
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().code, ErrorCode::not_found);
    const auto long_ago = total({.hours = 1, .until = steady_start - std::chrono::hours(9)});
    ASSERT_FALSE(long_ago);
    EXPECT_EQ(long_ago.error().message, "a rain total needs at least two volumes");
}

TEST(RainSourcesOfFiles, AnHourOfADirectoryThatHoldsHalfOfIt) {
    STORMCELLAR_NEED_DATA();
    GridOptions options;
    options.files = {(*testing::data_directory() / "sequence-kbgm").string()};
    options.moment = "RATE";
    options.threads = 2;
    const auto made = rain_total_of_files(options, {.hours = 1, .threads = 2});
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_EQ(made->name(), "KBGM");
    const auto facts = render::frame_facts_of("KBGM", made->description(), "UTC");
    EXPECT_THAT(facts.rain, HasSubstr("60 minutes, "));
    EXPECT_THAT(facts.rain, HasSubstr(" of them without volumes"));
    EXPECT_EQ(made->description().time - *facts.since, std::chrono::hours(1));
}

}  // namespace
}  // namespace stormcellar::cli
