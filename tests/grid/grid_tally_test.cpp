#include "grid/cells/grid_tally.h"

#include <cmath>

#include <gtest/gtest.h>

#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/grid/grid.h"

namespace stormcellar::grid {
namespace {

// Returns 20 columns by 18 rows and three levels, so that bricks are not full.
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

// Returns a grid with these cells; all other cells are not seen.
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

GridTally tally_of(const std::vector<std::vector<Cell>>& grids,
                   Tallied tallied = Tallied::columns) {
    GridTally tally(small_spec(), default_quantization(level2::Moment::ref), tallied);
    for (const auto& cells : grids)
        EXPECT_TRUE(tally.add(grid_of(cells).view()));
    return tally;
}

constexpr std::size_t column = 17 * 20 + 19;  // the last column

const std::vector<std::vector<Cell>> four_grids = {
    {{19, 17, 0, CellStatus::value, 20}, {19, 17, 1, CellStatus::value, 42.5}},
    {{19, 17, 2, CellStatus::no_echo}},
    {{19, 17, 0, CellStatus::value, -30.5}, {19, 17, 2, CellStatus::value, 18.5}},
    {{0, 0, 0, CellStatus::range_folded}},
};

TEST(GridTally, CountsWhatIsSeenApartFromWhatHasNoEcho) {
    const GridTally tally = tally_of(four_grids);
    EXPECT_EQ(tally.grids(), 4U);
    EXPECT_EQ(tally.columns().seen(column), 3U);
    EXPECT_EQ(tally.columns().with_value(column), 2U);
    EXPECT_EQ(tally.columns().seen(0), 1U);
    EXPECT_EQ(tally.columns().with_value(0), 0U);
    EXPECT_EQ(tally.columns().seen(1), 0U);
}

TEST(GridTally, KnowsFrequenciesMeansAndTops) {
    const GridTally tally = tally_of(four_grids);
    const auto from = [&](double dbz) {
        for (std::size_t bin = 1; bin < ValueTally::bins; ++bin) {
            if (ValueTally::edge_dbz(bin) == dbz) return tally.columns().from_bin_on(column, bin);
        }
        return ~std::uint32_t{0};
    };
    EXPECT_EQ(from(-30), 2U);
    EXPECT_EQ(from(20), 1U);
    EXPECT_EQ(from(40), 1U);
    EXPECT_EQ(from(45), 0U);
    EXPECT_EQ(ValueTally::edge_dbz(ValueTally::bins - 1), 75);
    EXPECT_EQ(tally.columns().greatest_dbz(column), 42.5);
    EXPECT_EQ(tally.columns().mean_dbz(column), (42.5 + 18.5) / 2);
    const double z = (std::pow(10, 4.25) + std::pow(10, 1.85)) / 2;
    EXPECT_NEAR(tally.columns().mean_z_as_dbz(column), 10 * std::log10(z), 1e-6);
    EXPECT_NEAR(tally.columns().quantile_dbz(column, 0.5), 18.5, 2.5);
    EXPECT_NEAR(tally.columns().quantile_dbz(column, 0.99), 42.5, 2.5);
    // The echo tops are at 2000 m and at 4000 m, where the value is 18.5 dBZ exactly.
    EXPECT_EQ(tally.tops_from(column, 0), 2U);
    EXPECT_EQ(tally.tops_from(column, 1), 2U);
    EXPECT_EQ(tally.tops_from(column, 2), 1U);
}

TEST(GridTally, CountsEachCellWhereAsked) {
    EXPECT_FALSE(tally_of(four_grids).cells());
    const GridTally tally = tally_of(four_grids, Tallied::columns_and_cells);
    const ValueTally& cells = *tally.cells();
    const auto at = [](int iz) { return small_spec().index(19, 17, iz); };
    EXPECT_EQ(cells.seen(at(0)), 2U);
    EXPECT_EQ(cells.with_value(at(0)), 2U);
    EXPECT_EQ(cells.mean_dbz(at(0)), (20 - 30.5) / 2);
    EXPECT_EQ(cells.seen(at(1)), 1U);
    EXPECT_EQ(cells.greatest_dbz(at(1)), 42.5);
    EXPECT_EQ(cells.seen(at(2)), 2U);
    EXPECT_EQ(cells.with_value(at(2)), 1U) << "no echo does not count as a value";
    EXPECT_EQ(cells.seen(small_spec().index(0, 0, 0)), 1U) << "a folded cell is seen";
    EXPECT_EQ(cells.seen(small_spec().index(0, 0, 1)), 0U);
    // The same tally also counts columns.
    EXPECT_EQ(tally.columns().seen(column), 3U);

    const auto bytes = tally.to_bytes();
    EXPECT_EQ(bytes.size(), GridTally::bytes_of(small_spec(), Tallied::columns_and_cells));
    GridTally back(small_spec(), default_quantization(level2::Moment::ref),
                   Tallied::columns_and_cells);
    ASSERT_TRUE(back.from_bytes(bytes));
    EXPECT_EQ(back.to_bytes(), bytes);
    EXPECT_EQ(back.add(tally_of(four_grids)).error().code, ErrorCode::bad_argument);
}

TEST(GridTally, SumsOfPartsInAnyOrderAreTheWholeToTheBit) {
    const GridTally whole = tally_of(four_grids);
    const GridTally parts[] = {tally_of({four_grids[2], four_grids[0]}), tally_of({four_grids[3]}),
                               tally_of({four_grids[1]})};
    for (const auto& order : {std::vector{0, 1, 2}, std::vector{2, 0, 1}, std::vector{1, 2, 0}}) {
        GridTally sum(small_spec(), default_quantization(level2::Moment::ref));
        for (const int part : order)
            ASSERT_TRUE(sum.add(parts[part]));
        EXPECT_EQ(sum.to_bytes(), whole.to_bytes());
    }
}

TEST(GridTally, ComesBackFromItsBytesAndRefusesOthers) {
    const GridTally tally = tally_of(four_grids);
    auto bytes = tally.to_bytes();
    EXPECT_EQ(bytes.size(), GridTally::bytes_of(small_spec(), Tallied::columns));
    GridTally back(small_spec(), default_quantization(level2::Moment::ref));
    ASSERT_TRUE(back.from_bytes(bytes));
    EXPECT_EQ(back.to_bytes(), bytes);
    bytes.pop_back();
    EXPECT_EQ(back.from_bytes(bytes).error().code, ErrorCode::truncated);
    bytes.push_back(std::byte{0xFF});
    EXPECT_EQ(back.from_bytes(bytes).error().code, ErrorCode::corrupt);

    GridSpec wider = small_spec();
    wider.nx = 40;
    GridTally other(wider, default_quantization(level2::Moment::ref));
    EXPECT_EQ(other.add(tally).error().code, ErrorCode::bad_argument);
    EXPECT_EQ(other.add(grid_of(four_grids[0]).view()).error().code, ErrorCode::bad_argument);
}

}  // namespace
}  // namespace stormcellar::grid
