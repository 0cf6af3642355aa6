#include "grid/cells/compare_bricks.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "stormcellar/grid/brick_grid.h"

namespace stormcellar::grid {
namespace {

Grid random_grid(unsigned seed, double shift) {
    Grid grid;
    grid.spec.nx = 37;
    grid.spec.ny = 21;
    for (int iz = 0; iz < 19; ++iz)
        grid.spec.levels_m.push_back(500.0 * iz);
    grid.values.assign(grid.spec.cell_count(), 0);
    grid.status.assign(grid.spec.cell_count(), CellStatus::not_seen);
    std::mt19937 random(seed);
    for (std::size_t cell = 0; cell < grid.status.size(); ++cell) {
        // A third of the columns is not seen, so some bricks are uniform.
        if ((cell / grid.spec.levels_m.size()) % 37 > 24) continue;
        grid.status[cell] = static_cast<CellStatus>(random() % 4);
        grid.values[cell] = static_cast<float>(static_cast<double>(cell % 60) + shift);
    }
    return grid;
}

TEST(CompareBricks, AgreesWithCellAfterCell) {
    const Grid a = random_grid(1, 0), b = random_grid(2, 2.5);
    const BrickGrid bricks_a = BrickGrid::from(a, {1, -32, 0.5F});
    const BrickGrid bricks_b = BrickGrid::from(b, {2, -32, 1.0F / 128});
    const auto found = compare_bricks(bricks_a.view(), bricks_b.view(), 1);
    ASSERT_TRUE(found);
    std::uint64_t compared = 0, disagreeing = 0, valued = 0;
    for (std::size_t cell = 0; cell < a.status.size(); ++cell) {
        if (a.status[cell] == CellStatus::not_seen && b.status[cell] == CellStatus::not_seen)
            continue;
        ++compared;
        if (a.status[cell] != b.status[cell]) ++disagreeing;
        if (a.status[cell] == CellStatus::value && b.status[cell] == CellStatus::value) ++valued;
    }
    EXPECT_EQ(found->status.compared, compared);
    EXPECT_EQ(found->status.disagreeing, disagreeing);
    ASSERT_EQ(found->values.size(), valued);
    ASSERT_GT(valued, 100U);
    for (const float difference : found->values)
        EXPECT_NEAR(difference, -2.5, 1e-4);
    EXPECT_NEAR(found->summary()->p99, 2.5, 1e-4);
    const auto threads = compare_bricks(bricks_a.view(), bricks_b.view(), 3);
    EXPECT_EQ(threads->values, found->values);
    EXPECT_EQ(threads->status, found->status);
}

TEST(CompareBricks, OfNothingSeenHasNoErrors) {
    Grid grid = random_grid(1, 0);
    std::fill(grid.status.begin(), grid.status.end(), CellStatus::not_seen);
    const BrickGrid bricks = BrickGrid::from(grid, {});
    const auto found = compare_bricks(bricks.view(), bricks.view(), 2);
    ASSERT_TRUE(found);
    EXPECT_FALSE(found->summary());
    EXPECT_EQ(found->status.compared, 0U);
}

TEST(CompareBricks, RefusesOtherCells) {
    const Grid a = random_grid(1, 0);
    Grid b = a;
    b.spec.spacing_m *= 2;
    const BrickGrid bricks_a = BrickGrid::from(a, {}), bricks_b = BrickGrid::from(b, {});
    const auto found = compare_bricks(bricks_a.view(), bricks_b.view(), 1);
    ASSERT_FALSE(found);
    EXPECT_EQ(found.error().code, ErrorCode::bad_argument);
}

}  // namespace
}  // namespace stormcellar::grid
