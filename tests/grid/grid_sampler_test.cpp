#include "stormcellar/grid/grid_sampler.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "stormcellar/grid/brick_grid.h"

namespace stormcellar::grid {
namespace {

// Returns 20 x 18 columns and three uneven levels, in several bricks. Values are linear in x, y and
// height.
Grid linear_grid() {
    Grid grid;
    grid.spec.nx = 20;
    grid.spec.ny = 18;
    grid.spec.levels_m = {500, 1000, 3000};
    grid.values.resize(grid.spec.cell_count());
    grid.status.assign(grid.spec.cell_count(), CellStatus::value);
    for (int iy = 0; iy < 18; ++iy) {
        for (int ix = 0; ix < 20; ++ix) {
            for (int iz = 0; iz < 3; ++iz) {
                grid.values[grid.spec.index(ix, iy, iz)] = static_cast<float>(
                    ix + 0.5 * iy + grid.spec.levels_m[static_cast<std::size_t>(iz)] / 500);
            }
        }
    }
    return grid;
}

TEST(GridSampler, IsLinearBetweenCells) {
    const BrickGrid bricks = BrickGrid::from(linear_grid(), {1, -32, 0.5F});
    const GridSampler sampler(bricks.view());
    for (const double x : {0.0, 3.25, 15.5, 18.75, 19.0}) {
        for (const double y : {0.0, 7.5, 15.9, 17.0}) {
            for (const double height_m : {500.0, 750.0, 1000.0, 2900.0, 3000.0}) {
                const auto value = sampler.value({x, y}, sampler.level_at(height_m));
                ASSERT_TRUE(value) << x << ' ' << y << ' ' << height_m;
                EXPECT_NEAR(*value, x + 0.5 * y + height_m / 500, 1e-5);
            }
        }
    }
}

TEST(GridSampler, BeyondTheOutermostCellsIsNothing) {
    const BrickGrid bricks = BrickGrid::from(linear_grid(), {});
    const GridSampler sampler(bricks.view());
    GridSampler::Corners corners;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(sampler.find({0, 0}, 0, corners));
    EXPECT_FALSE(sampler.find({-0.01, 0}, 0, corners));
    EXPECT_FALSE(sampler.find({0, 17.01}, 0, corners));
    EXPECT_FALSE(sampler.find({0, 0}, 2.01, corners));
    EXPECT_FALSE(sampler.find({nan, 0}, 0, corners));
    EXPECT_FALSE(sampler.find({0, 0}, nan, corners));
    EXPECT_TRUE(std::isnan(sampler.level_at(499)));
    EXPECT_TRUE(std::isnan(sampler.level_at(3001)));
    EXPECT_TRUE(std::isnan(sampler.level_at(nan)));
}

// The corners that find() returns must have the status and value of the view's cells, in every kind
// of brick.
TEST(GridSampler, ReadsEveryKindOfBrickAsTheViewDoes) {
    Grid grid = linear_grid();
    for (std::size_t i = 0; i < grid.status.size(); ++i) {
        const std::size_t ix = i / 3 % 20;
        if (ix >= 16) grid.status[i] = i % 3 == 0 ? CellStatus::no_echo : CellStatus::not_seen;
        if (ix < 16 && i % 7 == 0) grid.status[i] = CellStatus::range_folded;
        if (ix < 16 && i % 11 == 0) grid.status[i] = CellStatus::ambiguous;
    }
    const BrickGrid bricks = BrickGrid::from(grid, {1, -32, 0.5F, true});
    const BrickView view = bricks.view();
    const GridSampler sampler(view);
    GridSampler::Corners corners;
    for (int iy = 0; iy < 17; ++iy) {
        for (int ix = 0; ix < 19; ++ix) {
            for (int iz = 0; iz < 2; ++iz) {
                ASSERT_TRUE(sampler.find({ix + 0.25, iy + 0.5}, iz + 0.125, corners));
                EXPECT_EQ(corners[0].status, view.status(ix, iy, iz));
                EXPECT_EQ(corners[7].status, view.status(ix + 1, iy + 1, iz + 1));
                if (corners[0].status == CellStatus::value) {
                    EXPECT_EQ(corners[0].value, view.value(ix, iy, iz));
                }
                EXPECT_FLOAT_EQ(corners[0].weight, 0.75F * 0.5F * 0.875F);
                EXPECT_FLOAT_EQ(corners[7].weight, 0.25F * 0.5F * 0.125F);
            }
        }
    }
}

}  // namespace
}  // namespace stormcellar::grid
