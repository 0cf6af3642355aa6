#include "grid/cells/column_tally.h"

#include <cmath>

#include <gtest/gtest.h>

#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/grid/grid.h"

namespace stormcellar::grid {
namespace {

// 20 columns by 18 rows and three levels, with bricks that are not full.
GridSpec small_spec() {
    GridSpec spec;
    spec.nx = 20;
    spec.ny = 18;
    spec.levels_m = {1000, 2000, 4000};
    return spec;
}

struct Cell {
    int ix, iy, iz;
    CellStatus status;
    float dbz = 0;
};

// Cells that are not named are not seen.
BrickGrid grid_of(const std::vector<Cell>& cells) {
    Grid grid;
    grid.spec = small_spec();
    grid.values.assign(grid.spec.cell_count(), 0);
    grid.status.assign(grid.spec.cell_count(), CellStatus::not_seen);
    for (const Cell& cell : cells) {
        grid.status[grid.spec.index(cell.ix, cell.iy, cell.iz)] = cell.status;
        grid.values[grid.spec.index(cell.ix, cell.iy, cell.iz)] = cell.dbz;
    }
    return BrickGrid::from(grid, default_quantization(level2::Moment::ref));
}

ColumnTally tally_of(const std::vector<std::vector<Cell>>& grids) {
    ColumnTally tally(small_spec(), default_quantization(level2::Moment::ref));
    for (const auto& cells : grids)
        EXPECT_TRUE(tally.add(grid_of(cells).view()));
    return tally;
}

constexpr std::size_t column = 17 * 20 + 19;  // the last one

const std::vector<std::vector<Cell>> four_grids = {
    {{19, 17, 0, CellStatus::value, 20}, {19, 17, 1, CellStatus::value, 42.5}},
    {{19, 17, 2, CellStatus::no_echo}},
    {{19, 17, 0, CellStatus::value, -30.5}, {19, 17, 2, CellStatus::value, 18.5}},
    {{0, 0, 0, CellStatus::range_folded}},
};

TEST(ColumnTally, CountsWhatIsSeenApartFromWhatHasNoEcho) {
    const ColumnTally tally = tally_of(four_grids);
    EXPECT_EQ(tally.grids(), 4U);
    EXPECT_EQ(tally.seen(column), 3U);
    EXPECT_EQ(tally.with_value(column), 2U);
    EXPECT_EQ(tally.seen(0), 1U);
    EXPECT_EQ(tally.with_value(0), 0U);
    EXPECT_EQ(tally.seen(1), 0U);
}

TEST(ColumnTally, KnowsFrequenciesMeansAndTops) {
    const ColumnTally tally = tally_of(four_grids);
    const auto from = [&](double dbz) {
        for (std::size_t bin = 1; bin < ColumnTally::bins; ++bin) {
            if (ColumnTally::edge_dbz(bin) == dbz) return tally.from_bin_on(column, bin);
        }
        return ~std::uint32_t{0};
    };
    EXPECT_EQ(from(-30), 2U);
    EXPECT_EQ(from(20), 1U);
    EXPECT_EQ(from(40), 1U);
    EXPECT_EQ(from(45), 0U);
    EXPECT_EQ(ColumnTally::edge_dbz(ColumnTally::bins - 1), 75);
    EXPECT_EQ(tally.greatest_dbz(column), 42.5);
    EXPECT_EQ(tally.mean_dbz(column), (42.5 + 18.5) / 2);
    const double z = (std::pow(10, 4.25) + std::pow(10, 1.85)) / 2;
    EXPECT_NEAR(tally.mean_z_as_dbz(column), 10 * std::log10(z), 1e-6);
    EXPECT_NEAR(tally.quantile_dbz(column, 0.5), 18.5, 2.5);
    EXPECT_NEAR(tally.quantile_dbz(column, 0.99), 42.5, 2.5);
    // The tops are at 2000 m and, with 18.5 dBZ itself, at 4000 m.
    EXPECT_EQ(tally.tops_from(column, 0), 2U);
    EXPECT_EQ(tally.tops_from(column, 1), 2U);
    EXPECT_EQ(tally.tops_from(column, 2), 1U);
}

TEST(ColumnTally, SumsOfPartsInAnyOrderAreTheWholeToTheBit) {
    const ColumnTally whole = tally_of(four_grids);
    const ColumnTally parts[] = {tally_of({four_grids[2], four_grids[0]}),
                                 tally_of({four_grids[3]}), tally_of({four_grids[1]})};
    for (const auto& order : {std::vector{0, 1, 2}, std::vector{2, 0, 1}, std::vector{1, 2, 0}}) {
        ColumnTally sum(small_spec(), default_quantization(level2::Moment::ref));
        for (const int part : order)
            ASSERT_TRUE(sum.add(parts[part]));
        EXPECT_EQ(sum.to_bytes(), whole.to_bytes());
    }
}

TEST(ColumnTally, ComesBackFromItsBytesAndRefusesOthers) {
    const ColumnTally tally = tally_of(four_grids);
    auto bytes = tally.to_bytes();
    EXPECT_EQ(bytes.size(), ColumnTally::bytes_of(small_spec()));
    ColumnTally back(small_spec(), default_quantization(level2::Moment::ref));
    ASSERT_TRUE(back.from_bytes(bytes));
    EXPECT_EQ(back.to_bytes(), bytes);
    bytes.pop_back();
    EXPECT_EQ(back.from_bytes(bytes).error().code, ErrorCode::truncated);
    bytes.push_back(std::byte{0xFF});
    EXPECT_EQ(back.from_bytes(bytes).error().code, ErrorCode::corrupt);

    GridSpec wider = small_spec();
    wider.nx = 40;
    ColumnTally other(wider, default_quantization(level2::Moment::ref));
    EXPECT_EQ(other.add(tally).error().code, ErrorCode::bad_argument);
    EXPECT_EQ(other.add(grid_of(four_grids[0]).view()).error().code, ErrorCode::bad_argument);
}

}  // namespace
}  // namespace stormcellar::grid
