#include "render/products/flat_field.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/products/cell_mixer.h"
#include "tests/render/synthetic_storm.h"

namespace stormcellar::render {
namespace {

using grid::CellStatus;
using level2::Moment;

constexpr Cell unseen = {CellStatus::not_seen, 0};
constexpr Cell quiet = {CellStatus::no_echo, 0};
constexpr Cell folded = {CellStatus::range_folded, 0};
constexpr Cell unsure = {CellStatus::ambiguous, 0};

// Returns one row of columns, with levels at 500, 1000 ... m. Each column lists its cells from the
// lowest up; all other cells have no echo.
grid::BrickGrid columns_of(const std::vector<std::vector<Cell>>& columns, int levels = 20,
                           bool has_ambiguous = false) {
    grid::GridSpec spec = small_spec(static_cast<int>(columns.size()), levels);
    spec.ny = 1;
    const auto grid = make_grid_of(spec, [&](int ix, int, int iz) {
        const auto& cells = columns[static_cast<std::size_t>(ix)];
        return static_cast<std::size_t>(iz) < cells.size() ? cells[static_cast<std::size_t>(iz)]
                                                           : quiet;
    });
    return bricks_of(grid, 1, has_ambiguous);
}

std::vector<Cell> repeated(const Cell& cell, int count) {
    return std::vector<Cell>(static_cast<std::size_t>(count), cell);
}

TEST(ReadColumn, AgreesWithTheSlowView) {
    grid::Grid storm = storm_grid(small_spec(40, 37, 8000, 450));
    for (std::size_t cell = 0; cell < storm.status.size(); cell += 7) {
        if (storm.status[cell] == CellStatus::value) storm.status[cell] = CellStatus::ambiguous;
    }
    for (const int bytes : {1, 2}) {
        const auto bricks = bricks_of(storm, bytes, true);
        const grid::BrickView view = bricks.view();
        ColumnCells cells;
        for (int iy = 0; iy < 40; ++iy) {
            for (int ix = 0; ix < 40; ++ix) {
                read_column(view, ix, iy, cells);
                ASSERT_EQ(cells.status.size(), 37U);
                for (int iz = 0; iz < 37; ++iz) {
                    const auto i = static_cast<std::size_t>(iz);
                    ASSERT_EQ(cells.status[i], view.status(ix, iy, iz));
                    ASSERT_EQ(cells.values[i],
                              cells.status[i] == CellStatus::value ? view.value(ix, iy, iz) : 0);
                }
            }
        }
    }
}

TEST(Cappi, IsLinearBetweenLevelsAndTheLevelItselfAtOne) {
    const auto bricks = columns_of({{valued(10), valued(30)}, {valued(40), quiet}});
    const auto at = [&](double height_m) {
        return cappi_field(bricks.view(), Moment::ref, height_m, 1).value();
    };
    EXPECT_FLOAT_EQ(at(500).values[0], 10);
    EXPECT_FLOAT_EQ(at(250).values[0], 10) << "the first cell reaches half a level lower";
    EXPECT_FLOAT_EQ(at(625).values[0], 15);
    EXPECT_FLOAT_EQ(at(1000).values[0], 30);
    // Between a value and no echo, the heavier state counts, and the value is unchanged.
    EXPECT_EQ(at(700).status[1], CellStatus::value);
    EXPECT_FLOAT_EQ(at(700).values[1], 40);
    EXPECT_EQ(at(750).status[1], CellStatus::value) << "if the weights are equal, the value counts";
    EXPECT_EQ(at(800).status[1], CellStatus::no_echo);
}

// Checks the status rule (docs/geometry.md) for every pair of states, a third of the way between
// two levels and in their middle.
TEST(Cappi, MixesStatesByTheRule) {
    const std::vector<Cell> kinds = {unseen, quiet, folded, unsure, valued(20)};
    std::vector<std::vector<Cell>> columns;
    for (const Cell& lower : kinds) {
        for (const Cell& upper : kinds)
            columns.push_back({lower, upper});
    }
    const auto bricks = columns_of(columns, 20, true);
    const double third_up = 500 + 500.0 / 3;
    const auto near_lower = cappi_field(bricks.view(), Moment::veld, third_up, 1).value();
    const auto half = cappi_field(bricks.view(), Moment::veld, 750, 1).value();
    for (std::size_t i = 0; i < columns.size(); ++i) {
        const CellStatus lower = columns[i][0].status;
        const CellStatus upper = columns[i][1].status;
        EXPECT_EQ(near_lower.status[i], lower) << i << ": two thirds of the weight";
        // Both states have half of the weight. "Not seen" needs more than half, so the seen state
        // counts.
        CellStatus wanted = lower;
        if (lower == CellStatus::not_seen) wanted = upper;
        if (lower != upper && lower != CellStatus::not_seen && upper != CellStatus::not_seen) {
            const bool has_value = lower == CellStatus::value || upper == CellStatus::value;
            wanted = has_value ? CellStatus::value : half.status[i];
            EXPECT_NE(half.status[i], CellStatus::not_seen);
        }
        if (lower == CellStatus::value && upper == CellStatus::not_seen) wanted = lower;
        EXPECT_EQ(half.status[i], wanted) << i;
        for (const FlatField* field : {&near_lower, &half}) {
            if (field->status[i] != CellStatus::value) continue;
            EXPECT_EQ(field->values[i], 20) << "no state enters a value";
        }
    }
}

TEST(Cappi, OfPhaseGoesTheShortWayRoundAndVelocitiesAreNotAveraged) {
    grid::GridSpec spec = small_spec(1, 2);
    const auto grid =
        make_grid_of(spec, [](int, int, int iz) { return valued(iz == 0 ? 350 : 20); });
    const auto bricks = grid::BrickGrid::from(grid, grid::default_quantization(Moment::phi));
    EXPECT_NEAR(cappi_field(bricks.view(), Moment::phi, 800, 1)->values[0], 8, 1e-3);
    EXPECT_NEAR(cappi_field(bricks.view(), Moment::phi, 600, 1)->values[0], 356, 1e-3);
    EXPECT_FLOAT_EQ(cappi_field(bricks.view(), Moment::vel, 800, 1)->values[0], 20);
    EXPECT_FLOAT_EQ(cappi_field(bricks.view(), Moment::vel, 600, 1)->values[0], 350);
    EXPECT_FLOAT_EQ(cappi_field(bricks.view(), Moment::sw, 750, 1)->values[0], 185);
}

TEST(Cappi, RefusesHeightsWithoutCells) {
    const auto bricks = columns_of({{quiet}}, 4);
    for (const double height_m : {249.0, 2251.0, std::nan("")}) {
        const auto refused = cappi_field(bricks.view(), Moment::ref, height_m, 1);
        ASSERT_FALSE(refused);
        EXPECT_EQ(refused.error().code, ErrorCode::bad_argument);
        EXPECT_THAT(refused.error().message, ::testing::HasSubstr("0.25 to 2.25 km"));
    }
}

TEST(EchoTops, AreInterpolatedBetweenLevelsInDecibels) {
    const auto bricks = columns_of({
        {valued(50), valued(40), valued(10)},          // 40 at 1 km, 10 at 1.5 km
        {valued(50), quiet},                           // nothing above 0.5 km
        {valued(50), unseen, quiet},                   // not seen above
        {valued(50), folded},                          // folded above
        {valued(18), quiet, valued(18.5), valued(3)},  // exactly the threshold
        {valued(18), folded, quiet},                   // below the threshold, and folded
        {valued(18)},                                  // below the threshold
        repeated(unseen, 20),
        repeated(valued(30), 20),                              // up to the grid's top
        {valued(60), quiet, quiet, valued(30), valued(12.5)},  // an overhang counts
    });
    const FlatField field = echo_top_field(bricks.view(), 18.5, 2);
    EXPECT_NEAR(field.values[0], 1.0 + 0.5 * (40 - 18.5) / 30, 1e-6);
    EXPECT_FLOAT_EQ(field.values[1], 0.5F);
    EXPECT_FLOAT_EQ(field.values[2], 0.5F);
    EXPECT_FLOAT_EQ(field.values[4], 1.5F);
    EXPECT_FLOAT_EQ(field.values[8], 10);
    EXPECT_NEAR(field.values[9], 2.0 + 0.5 * 11.5 / 17.5, 1e-6);
    EXPECT_EQ(field.status[5], CellStatus::range_folded);
    EXPECT_EQ(field.status[6], CellStatus::no_echo);
    EXPECT_EQ(field.status[7], CellStatus::not_seen);
    const std::vector<std::uint8_t> at_least = {0, 0, 1, 1, 0, 0, 0, 0, 1, 0};
    EXPECT_EQ(field.at_least, at_least);
}

// The closed form is 3.44e-6 Z^(4/7) for each meter of the 20 levels of 500 m.
TEST(Vil, OfAnEvenColumnIsItsClosedForm) {
    const auto bricks =
        columns_of({repeated(valued(45), 20), repeated(valued(56), 20), repeated(valued(70), 20),
                    repeated(quiet, 20), repeated(unseen, 20), repeated(folded, 20)});
    const FlatField field = vil_field(bricks.view(), {}, 2);
    EXPECT_NEAR(field.values[0], 3.44e-6 * std::pow(10, 4.5 * 4 / 7) * 10000, 1e-4);
    EXPECT_NEAR(field.values[1], 3.44e-6 * std::pow(10, 5.6 * 4 / 7) * 10000, 1e-3);
    EXPECT_EQ(field.values[2], field.values[1]) << "capped at 56 dBZ, for hail";
    EXPECT_EQ(field.status[3], CellStatus::no_echo);
    EXPECT_EQ(field.status[4], CellStatus::not_seen);
    EXPECT_EQ(field.status[5], CellStatus::range_folded);
}

TEST(Vil, TakesTheMeanOfZInALayerAndLeavesOutWhatWasNotSeen) {
    const double z40 = 1e4;
    const double full = std::pow(z40, 4.0 / 7);
    const double halved = std::pow(z40 / 2, 4.0 / 7);
    std::vector<Cell> hidden = repeated(unseen, 20);
    hidden[5] = valued(40);
    std::vector<Cell> single = repeated(quiet, 20);
    single[5] = valued(40);
    const auto bricks = columns_of({hidden, single});
    const FlatField field = vil_field(bricks.view(), {}, 1);
    EXPECT_NEAR(field.values[0], 3.44e-6 * full * 500, 1e-6) << "half of each layer counts";
    EXPECT_NEAR(field.values[1], 3.44e-6 * halved * 1000, 1e-6) << "both layers have Z / 2";
}

// The echo top and the height of the maximum, found in a slow and obvious way from single cells.
struct SlowColumn {
    std::optional<double> top_m;
    std::optional<double> height_km;
};
SlowColumn slow_column(const grid::BrickView& view, int ix, int iy, double threshold_dbz) {
    const auto& levels_m = view.spec->levels_m;
    SlowColumn slow;
    double largest = -1e9;
    for (int iz = 0; iz < view.spec->nz(); ++iz) {
        if (view.status(ix, iy, iz) != CellStatus::value) continue;
        const auto dbz = static_cast<double>(view.value(ix, iy, iz));
        if (dbz < threshold_dbz) continue;
        const double here_m = levels_m[static_cast<std::size_t>(iz)];
        if (dbz > largest) slow.height_km = here_m / 1000;
        largest = std::max(largest, dbz);
        slow.top_m = here_m;
        const bool goes_on =
            iz + 1 < view.spec->nz() && view.status(ix, iy, iz + 1) == CellStatus::value;
        if (!goes_on) continue;
        const auto above = static_cast<double>(view.value(ix, iy, iz + 1));
        const double step_m = levels_m[static_cast<std::size_t>(iz) + 1] - here_m;
        if (above < threshold_dbz) {
            slow.top_m = here_m + step_m * (dbz - threshold_dbz) / (dbz - above);
        }
    }
    return slow;
}

TEST(VilDensity, AndTheHeightOfTheMaximumAgreeWithTheSlowForm) {
    const auto bricks = bricks_of(storm_grid(small_spec(40, 30, 8000, 500)));
    const grid::BrickView view = bricks.view();
    constexpr double radar_m = 370;
    const FlatField density = vil_density_field(view, 18.5, radar_m, 2);
    const FlatField height = maximum_height_field(view, 18.5, 2);
    const FlatField vil = vil_field(view, radar_m, 1);
    int valued = 0;
    for (int iy = 0; iy < 40; ++iy) {
        for (int ix = 0; ix < 40; ++ix) {
            const SlowColumn slow = slow_column(view, ix, iy, 18.5);
            const std::size_t at = density.index(ix, iy);
            ASSERT_EQ(density.status[at] == CellStatus::value, slow.top_m.has_value());
            ASSERT_EQ(height.status[at] == CellStatus::value, slow.height_km.has_value());
            if (!slow.top_m) continue;
            ++valued;
            const double wanted =
                1000 * static_cast<double>(vil.values[at]) / std::max(500.0, *slow.top_m - radar_m);
            ASSERT_NEAR(static_cast<double>(density.values[at]), wanted, 1e-5 * wanted + 1e-6);
            ASSERT_FLOAT_EQ(height.values[at], static_cast<float>(*slow.height_km));
        }
    }
    EXPECT_GT(valued, 30);
}

TEST(VilDensity, IsVilOverTheHeightOfTheTopAboveTheRadar) {
    const auto bricks = columns_of({repeated(valued(45), 10),
                                    {quiet},
                                    repeated(unseen, 20),
                                    repeated(folded, 20),
                                    {valued(45)}});
    const grid::BrickView view = bricks.view();
    const FlatField density = vil_density_field(view, 18.5, 1000, 1);
    const FlatField vil = vil_field(view, 1000, 1);
    EXPECT_FLOAT_EQ(density.values[0], vil.values[0] * 1000 / 4000)
        << "the echo reaches up to 5 km";
    EXPECT_EQ(density.status[1], CellStatus::no_echo);
    EXPECT_EQ(density.status[2], CellStatus::not_seen);
    EXPECT_EQ(density.status[3], CellStatus::range_folded);
    EXPECT_FLOAT_EQ(density.values[4], vil.values[4] * 1000 / 500) << "the top is below the radar";
    EXPECT_TRUE(density.at_least.empty());
    FrameFacts facts;
    facts.sites = {{"KAAA", 35, -97, 300}, {"KBBB", 36, -97, 500}};
    EXPECT_DOUBLE_EQ(radar_height_m(facts), 400);
}

TEST(MaximumHeight, IsThatOfTheLowestOfTheLargestCells) {
    const auto bricks = columns_of({{valued(20), valued(40), valued(40), valued(30)},
                                    {valued(10), valued(12)},
                                    repeated(unseen, 20),
                                    {folded, valued(30)}});
    const FlatField field = maximum_height_field(bricks.view(), 18.5, 1);
    EXPECT_FLOAT_EQ(field.values[0], 1);
    EXPECT_EQ(field.status[1], CellStatus::no_echo) << "the echo is below the threshold";
    EXPECT_EQ(field.status[2], CellStatus::not_seen);
    EXPECT_FLOAT_EQ(field.values[3], 1);
}

// With the radar at 370 m, the levels of the layer from 0 to 2 km are those of 500 to 2000 m.
TEST(LayerMaximum, IsTheLargestOfTheCellsInTheLayer) {
    const auto bricks = columns_of({{valued(-4), valued(-9), quiet, valued(-6), valued(30)},
                                    {valued(2), unsure, valued(7), folded, valued(30)},
                                    {quiet, quiet, unsure, quiet, valued(30)},
                                    {unseen, unseen, folded, quiet, valued(30)},
                                    repeated(unseen, 20)},
                                   20, true);
    const HeightLayer low{0, 2000};
    const FlatField field = layer_maximum_field(bricks.view(), low, 370, 2).value();
    EXPECT_FLOAT_EQ(field.values[0], -4) << "not the value farthest from zero";
    EXPECT_FLOAT_EQ(field.values[1], 7);
    EXPECT_EQ(field.status[2], CellStatus::ambiguous);
    EXPECT_EQ(field.status[3], CellStatus::range_folded);
    EXPECT_EQ(field.status[4], CellStatus::not_seen);
    const FlatField higher = layer_maximum_field(bricks.view(), low, 500, 1).value();
    EXPECT_FLOAT_EQ(higher.values[0], -4) << "the bottom belongs to the layer, the top does not";
    EXPECT_FLOAT_EQ(layer_maximum_field(bricks.view(), low, 501, 1)->values[0], 30);
    const auto none = layer_maximum_field(bricks.view(), low, 12'000, 1);
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().code, ErrorCode::bad_argument);
    EXPECT_EQ(none.error().message,
              "the grid has no level from 0 to 2000 m above the radar, which is at 12000 m above "
              "sea level");
}

TEST(HeightsSeen, AreThoseOfTheOutermostCellsSeen) {
    const auto bricks = columns_of({{unseen, unseen, quiet},
                                    {folded},
                                    repeated(unseen, 20),
                                    {unseen, valued(3), unseen, unseen, valued(9)}},
                                   6);
    const FlatField lowest = lowest_seen_field(bricks.view(), 1);
    const FlatField highest = highest_seen_field(bricks.view(), 1);
    EXPECT_FLOAT_EQ(lowest.values[0], 1.5F);
    EXPECT_FLOAT_EQ(lowest.values[1], 0.5F);
    EXPECT_FLOAT_EQ(lowest.values[3], 1);
    EXPECT_FLOAT_EQ(highest.values[3], 3);
    EXPECT_EQ(lowest.status[2], CellStatus::not_seen);
    EXPECT_EQ(highest.status[2], CellStatus::not_seen);
}

TEST(FlatFields, AreTheSameForAnyNumberOfThreads) {
    const auto bricks = bricks_of(storm_grid(small_spec(90, 30, 4000, 500)));
    const auto view = bricks.view();
    for (const int threads : {2, 5}) {
        EXPECT_EQ(echo_top_field(view, 18.5, threads).values, echo_top_field(view, 18.5, 1).values);
        EXPECT_EQ(vil_field(view, 0, threads).values, vil_field(view, 0, 1).values);
        EXPECT_EQ(cappi_field(view, Moment::ref, 3210, threads)->values,
                  cappi_field(view, Moment::ref, 3210, 1)->values);
    }
}

}  // namespace
}  // namespace stormcellar::render
