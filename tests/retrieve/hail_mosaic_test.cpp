// Tests that the hail of a mosaic is the largest hail of its radars, column by column.
#include "retrieve/hail/hail_mosaic.h"

#include <algorithm>
#include <limits>

#include <gtest/gtest.h>

namespace stormcellar::retrieve {
namespace {

using grid::CellStatus;

constexpr FreezingLevels mosaic_levels{2000, 5000};

grid::Grid empty_columns() {
    grid::Grid made;
    made.spec = grid::default_spec(35, -97);
    made.spec.nx = 12;
    made.spec.ny = 7;
    made.spec.levels_m.clear();
    for (int i = 1; i <= 20; ++i)
        made.spec.levels_m.push_back(500.0 * i);
    made.values.assign(made.spec.cell_count(), 0);
    made.status.assign(made.spec.cell_count(), CellStatus::no_echo);
    return made;
}

// Returns echo that grows to the east by `step_dbz` a column, up to a top.
grid::Grid slanted_echo(float west_dbz, float step_dbz, int top) {
    grid::Grid made = empty_columns();
    for (int iy = 0; iy < made.spec.ny; ++iy)
        for (int ix = 0; ix < made.spec.nx; ++ix)
            for (int iz = 0; iz < top; ++iz) {
                made.status[made.spec.index(ix, iy, iz)] = CellStatus::value;
                made.values[made.spec.index(ix, iy, iz)] =
                    west_dbz + step_dbz * static_cast<float>(ix);
            }
    return made;
}

// Returns SHI of a column.
float shi_of(const grid::Grid& of, int ix, int iy) {
    const auto layers = hail_layers(of.spec.levels_m, mosaic_levels, 0).value();
    std::vector<float> dbz;
    for (int iz = 0; iz < of.spec.nz(); ++iz) {
        const std::size_t cell = of.spec.index(ix, iy, iz);
        dbz.push_back(of.status[cell] == CellStatus::value
                          ? of.values[cell]
                          : std::numeric_limits<float>::quiet_NaN());
    }
    return hail_of_column(layers, dbz).shi_j_per_m_s;
}

TEST(HailMosaic, HasTheLargestHailOfItsRadarsInEachColumn) {
    const grid::Grid east = slanted_echo(30, 3, 14), west = slanted_echo(62, -3, 18);
    grid::Grid mosaic = slanted_echo(45, 0, 16);  // what a mean might leave
    auto hail = HailMosaic::make(mosaic.spec, mosaic_levels);
    ASSERT_TRUE(hail);
    ASSERT_TRUE(hail->add(east, mosaic));
    ASSERT_TRUE(hail->add(west, mosaic));
    int from_east = 0, from_west = 0;
    for (int iy = 0; iy < mosaic.spec.ny; ++iy)
        for (int ix = 0; ix < mosaic.spec.nx; ++ix) {
            const float of_east = shi_of(east, ix, iy), of_west = shi_of(west, ix, iy);
            ASSERT_EQ(shi_of(mosaic, ix, iy), std::max(of_east, of_west)) << ix;
            from_east += of_east > of_west ? 1 : 0;
            from_west += of_west > of_east ? 1 : 0;
        }
    EXPECT_GT(from_east, 20);
    EXPECT_GT(from_west, 20);
}

// If the radar with the most hail sees only the lower half of a column, the column of the mosaic is
// not seen above that half.
TEST(HailMosaic, TakesStatesFromTheSameRadarAndKeepsColumnsWithoutHail) {
    grid::Grid half_seen = slanted_echo(60, 0, 10);
    for (int iz = 10; iz < half_seen.spec.nz(); ++iz)
        half_seen.status[half_seen.spec.index(3, 3, iz)] = CellStatus::not_seen;
    for (int iz = 0; iz < half_seen.spec.nz(); ++iz)
        half_seen.status[half_seen.spec.index(4, 3, iz)] = CellStatus::not_seen;
    grid::Grid mosaic = slanted_echo(38, 0, 10);
    auto hail = HailMosaic::make(mosaic.spec, mosaic_levels);
    ASSERT_TRUE(hail);
    ASSERT_TRUE(hail->add(half_seen, mosaic));
    EXPECT_EQ(mosaic.status[mosaic.spec.index(3, 3, 10)], CellStatus::not_seen);
    EXPECT_EQ(mosaic.status[mosaic.spec.index(2, 3, 10)], CellStatus::no_echo);
    EXPECT_EQ(mosaic.status[mosaic.spec.index(4, 3, 9)], CellStatus::value) << "no hail seen there";
    EXPECT_EQ(mosaic.values[mosaic.spec.index(4, 3, 9)], 38);
}

TEST(HailMosaic, RefusesOtherCellsAndLevelsThatAreImpossible) {
    grid::Grid mosaic = empty_columns();
    auto hail = HailMosaic::make(mosaic.spec, mosaic_levels);
    ASSERT_TRUE(hail);
    grid::Grid other = empty_columns();
    other.spec.nx = 3;
    EXPECT_EQ(hail->add(other, mosaic).error().code, ErrorCode::bad_argument);
    EXPECT_FALSE(HailMosaic::make(mosaic.spec, {5000, 2000}));
    mosaic.spec.levels_m = {1000};
    EXPECT_FALSE(HailMosaic::make(mosaic.spec, mosaic_levels)) << "one level has no layer";
}

}  // namespace
}  // namespace stormcellar::retrieve
