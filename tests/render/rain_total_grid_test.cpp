// Tests the grid of rain totals: values, columns that were not seen, notes, and volumes that do not
// fit.
#include "render/products/rain_total_grid.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace stormcellar::render {
namespace {

using grid::CellStatus;

constexpr UtcTime rain_start{std::chrono::sys_days{std::chrono::year{2024} / 6 / 1}};

cache::GridDescription description_at(int minute, const char* icao = "KTLX") {
    cache::GridDescription made;
    made.spec = grid::default_spec(35, -97);
    made.spec.nx = made.spec.ny = 40;
    made.spec.levels_m = {1000, 2000};
    made.moment = level2::Moment::rate;
    made.time = made.start_time = made.end_time = rain_start + std::chrono::minutes{minute};
    made.sites = {{icao, 35, -97, 300}};
    return made;
}

// Returns rain of 12 mm/h. The first rows are not seen.
grid::BrickGrid steady_rain(const grid::GridSpec& spec, int unseen_rows) {
    grid::Grid rain;
    rain.spec = spec;
    rain.moment = level2::Moment::rate;
    rain.values.assign(spec.cell_count(), 12);
    rain.status.assign(spec.cell_count(), CellStatus::value);
    std::fill_n(rain.status.begin(), spec.index(0, unseen_rows, 0), CellStatus::not_seen);
    std::fill_n(rain.values.begin(), spec.index(0, unseen_rows, 0), 0.0F);
    return grid::BrickGrid::from(rain, grid::default_quantization(level2::Moment::rate));
}

TEST(RainTotalGrid, AddsUpRainAndMarksColumnsThatWereNotSeen) {
    RainTotalGrid total;
    const auto first = description_at(0);
    ASSERT_TRUE(total.add(steady_rain(first.spec, 10).view(), first, 1));
    EXPECT_FALSE(total.bricks()) << "one volume is no total";
    ASSERT_TRUE(total.add(steady_rain(first.spec, 10).view(), description_at(10), 1));
    ASSERT_TRUE(total.add(steady_rain(first.spec, 10).view(), description_at(20), 1));
    const auto made = total.bricks();
    ASSERT_TRUE(made);
    const grid::Grid rain = grid::to_dense(made->view());
    EXPECT_EQ(rain.spec.nz(), 1);
    EXPECT_EQ(rain.status[rain.spec.index(20, 5, 0)], CellStatus::not_seen);
    EXPECT_NEAR(rain.values[rain.spec.index(20, 30, 0)], 4, 0.02);
    const auto notes = total.description().provenance.notes;
    ASSERT_EQ(notes.size(), 1U);
    EXPECT_EQ(notes[0],
              "rain since 2024-06-01T00:00:00Z: 20 minutes; 3 volumes; 0 columns were not seen for "
              "a part of the time");

    ASSERT_TRUE(total.add(steady_rain(first.spec, 10).view(), description_at(70), 1));
    const grid::Grid gap = grid::to_dense(total.bricks()->view());
    EXPECT_EQ(gap.status[gap.spec.index(20, 30, 0)], CellStatus::ambiguous)
        << "50 minutes of 70 were not seen";
    EXPECT_EQ(total.description().provenance.notes[0],
              "rain since 2024-06-01T00:00:00Z: 70 minutes, 50 of them without volumes; 4 volumes; "
              "1200 columns were not seen for a part of the time");
    EXPECT_EQ(total.description().time, rain_start + std::chrono::minutes{70});
}

TEST(RainTotalGrid, RefusesOtherRadars) {
    RainTotalGrid total;
    const auto first = description_at(0);
    ASSERT_TRUE(total.add(steady_rain(first.spec, 0).view(), first, 1));
    const Status refused =
        total.add(steady_rain(first.spec, 0).view(), description_at(10, "KFDR"), 1);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().message, "the files of a rain total must be of one radar");
}

}  // namespace
}  // namespace stormcellar::render
