#include "stormcellar/grid/brick_grid.h"

#include <algorithm>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "base/checksum.h"

namespace stormcellar::grid {
namespace {

Grid grid_of(int nx, int ny, int nz, CellStatus status) {
    Grid grid;
    grid.spec.nx = nx;
    grid.spec.ny = ny;
    for (int iz = 0; iz < nz; ++iz)
        grid.spec.levels_m.push_back(100.0 * iz);
    grid.values.assign(grid.spec.cell_count(), 0);
    grid.status.assign(grid.spec.cell_count(), status);
    return grid;
}

// Returns a grid with three regions along x, so that every kind of brick occurs: uniform, states
// only, values. With `has_ambiguous`, two of the uniform bricks are ambiguous.
Grid mixed_grid(float least, float largest, bool has_ambiguous = false) {
    Grid grid = grid_of(37, 20, 19, CellStatus::not_seen);
    std::mt19937 random(7);
    std::uniform_real_distribution<float> value(least, largest);
    std::uniform_int_distribution<int> status(0, has_ambiguous ? 4 : 3);
    for (int iy = 0; iy < grid.spec.ny; ++iy) {
        for (int ix = 16; ix < grid.spec.nx; ++ix) {
            for (int iz = 0; iz < grid.spec.nz(); ++iz) {
                const std::size_t cell = grid.spec.index(ix, iy, iz);
                int drawn = status(random);
                if (ix < 32) drawn = std::min(drawn, 2);
                grid.status[cell] =
                    drawn == 4 ? CellStatus::ambiguous : static_cast<CellStatus>(drawn);
                if (drawn == 3) grid.values[cell] = value(random);
            }
        }
    }
    for (int iy = brick_edge; has_ambiguous && iy < grid.spec.ny; ++iy) {
        for (int ix = 0; ix < brick_edge; ++ix) {
            for (int iz = 0; iz < grid.spec.nz(); ++iz)
                grid.status[grid.spec.index(ix, iy, iz)] = CellStatus::ambiguous;
        }
    }
    return grid;
}

void expect_same_within_half_a_step(const Grid& grid, const Quantization& quantization) {
    const BrickGrid bricks = BrickGrid::from(grid, quantization);
    EXPECT_EQ(bricks.clamped_count(), 0U);
    const Grid back = to_dense(bricks.view());
    EXPECT_EQ(back.spec, grid.spec);
    ASSERT_EQ(back.status, grid.status);
    for (std::size_t cell = 0; cell < grid.values.size(); ++cell) {
        if (grid.status[cell] != CellStatus::value) continue;
        ASSERT_LE(std::abs(back.values[cell] - grid.values[cell]), quantization.step / 2);
    }
}

TEST(BrickGrid, GivesBackEveryStateAndValue) {
    expect_same_within_half_a_step(mixed_grid(-32, 94), {1, -32, 0.5F});
    expect_same_within_half_a_step(mixed_grid(-250, 250), {2, -256, 0.25F});
    expect_same_within_half_a_step(mixed_grid(-31.5F, 94, true), {1, -32, 0.5F, true});
    expect_same_within_half_a_step(mixed_grid(-320, 320, true),
                                   default_quantization(level2::Moment::veld));
}

// On 2026-11-29, ambiguous cells had code 4, which is the velocity -1023.75 m/s.
TEST(BrickGrid, AmbiguousCellsHaveTheCodeBelowAllValues) {
    for (const Quantization& quantization : {Quantization{1, -32, 0.5F, true}, {2, -32, 1, true}}) {
        const BrickGrid bricks =
            BrickGrid::from(grid_of(16, 16, 16, CellStatus::ambiguous), quantization);
        const BrickEntry& brick = bricks.view().bricks[0];
        EXPECT_EQ(brick.kind, BrickKind::stored);
        EXPECT_EQ(brick.min_code, first_value_code);
        EXPECT_EQ(brick.max_code, first_value_code);
        EXPECT_EQ(bricks.view().status(3, 4, 5), CellStatus::ambiguous);
    }
}

// 2026-11-29: ambiguous cells became code 4, which is the least value, -1023.75 m/s.
TEST(BrickGrid, GivesBackAmbiguousCells) {
    Grid grid = mixed_grid(-60, 60);
    grid.moment = level2::Moment::veld;
    for (std::size_t cell = 0; cell < grid.status.size(); cell += 3) {
        grid.status[cell] = CellStatus::ambiguous;
        grid.values[cell] = 0;
    }
    expect_same_within_half_a_step(grid, default_quantization(grid.moment));
    const Grid alone = grid_of(20, 20, 20, CellStatus::ambiguous);
    expect_same_within_half_a_step(alone, default_quantization(grid.moment));
}

TEST(BrickGrid, HoldsEveryKindOfBrick) {
    const BrickGrid bricks = BrickGrid::from(mixed_grid(0, 60), {1, -32, 0.5F});
    std::set<BrickKind> kinds;
    for (const BrickEntry& brick : bricks.view().bricks)
        kinds.insert(brick.kind);
    EXPECT_EQ(kinds.size(), 3U);
}

void expect_same_bytes(const BrickView& one, const BrickView& other) {
    const auto same = [](auto a, auto b) {
        return std::ranges::equal(std::as_bytes(a), std::as_bytes(b));
    };
    EXPECT_TRUE(same(one.codes, other.codes));
    EXPECT_TRUE(same(one.states, other.states));
    EXPECT_TRUE(same(one.bricks, other.bricks));
}

TEST(BrickGrid, ThreadsChangeNothing) {
    for (const Quantization& quantization : {Quantization{1, -32, 0.5F}, {2, -32, 0.25F}}) {
        const Grid grid = mixed_grid(-40, 60);  // some values are below the least value
        const BrickGrid wanted = BrickGrid::from(grid, quantization);
        EXPECT_GT(wanted.clamped_count(), 0U);
        EXPECT_GT(wanted.view().states.size(), 64U);
        for (const int threads : {0, 2, 3, 50}) {
            SCOPED_TRACE(threads);
            const BrickGrid bricks = BrickGrid::from(grid, quantization, threads);
            EXPECT_EQ(bricks.clamped_count(), wanted.clamped_count());
            expect_same_bytes(bricks.view(), wanted.view());
        }
    }
}

// Fills one brick of mixed_grid() with two alternating states.
void set_brick(Grid& grid, int bx, int by, int bz, CellStatus even, CellStatus odd) {
    const BrickExtent extent = brick_extent(grid.spec, bx, by, bz);
    for (int x = 0; x < extent.x; ++x) {
        for (int y = 0; y < extent.y; ++y) {
            for (int z = 0; z < extent.z; ++z) {
                const std::size_t cell =
                    grid.spec.index(bx * brick_edge + x, by * brick_edge + y, bz * brick_edge + z);
                grid.status[cell] = z % 2 == 0 ? even : odd;
            }
        }
    }
}

TEST(BrickGrid, BricksThatAreWrittenAgainInAnyOrderLeaveNoTrace) {
    const Quantization quantization{1, -32, 0.5F};
    const Grid before = mixed_grid(-32, 60);
    Grid after = before;
    set_brick(after, 0, 0, 0, CellStatus::no_echo, CellStatus::range_folded);   // replaces uniform
    set_brick(after, 1, 0, 0, CellStatus::no_echo, CellStatus::range_folded);   // replaces states
    set_brick(after, 1, 1, 0, CellStatus::range_folded, CellStatus::not_seen);  // replaces states
    set_brick(after, 1, 1, 1, CellStatus::no_echo, CellStatus::no_echo);        // replaces states
    set_brick(after, 2, 0, 1, CellStatus::not_seen, CellStatus::no_echo);       // replaces values
    const BrickGrid wanted = BrickGrid::from(after, quantization);
    BrickGrid made = BrickGrid::from(before, quantization);
    std::vector<BricksWriter> writers(2, BricksWriter(made));
    std::size_t next = 0;
    for (const std::size_t brick : {9U, 7U, 6U, 0U, 4U}) {
        made.clear(brick);
        writers[next++ % 2].copy(brick, wanted.view(), brick);
    }
    made.finish_again(writers);
    expect_same_bytes(made.view(), wanted.view());
}

TEST(BrickGrid, EntriesSumUpTheirBricks) {
    Grid grid = grid_of(16, 16, 32, CellStatus::no_echo);
    for (const auto& [iz, value] : {std::pair{0, 10.0F}, {3, -5.0F}, {15, 60.0F}}) {
        grid.status[grid.spec.index(4, 5, iz)] = CellStatus::value;
        grid.values[grid.spec.index(4, 5, iz)] = value;
    }
    const BrickGrid bricks = BrickGrid::from(grid, {1, -32, 0.5F});
    const BrickView view = bricks.view();
    ASSERT_EQ(view.bricks.size(), 2U);
    const BrickEntry& low = view.bricks[0];
    EXPECT_EQ(low.kind, BrickKind::stored);
    EXPECT_EQ(low.value_count, 3);
    EXPECT_EQ(view.quantization.value_of(low.min_code), -5.0F);
    EXPECT_EQ(view.quantization.value_of(low.max_code), 60.0F);
    EXPECT_EQ(low.checksum, xxh3_64(view.codes.first(brick_cells)));
    EXPECT_EQ(view.bricks[1].kind, BrickKind::uniform);
    EXPECT_EQ(view.bricks[1].uniform_status, CellStatus::no_echo);
}

TEST(BrickGrid, AbsentBricksReadAsZeros) {
    Grid grid = grid_of(16, 16, 16, CellStatus::no_echo);
    grid.status[0] = CellStatus::range_folded;
    const BrickGrid bricks = BrickGrid::from(grid, {1, -32, 0.5F});
    const BrickView view = bricks.view();
    EXPECT_EQ(view.bricks[0].kind, BrickKind::status_only);
    EXPECT_EQ(view.states.size(), brick_cells / 4);
    EXPECT_EQ(view.bricks[0].checksum, xxh3_64(view.states));
    for (const std::byte code : view.codes)
        ASSERT_EQ(code, std::byte{0});
}

TEST(BrickGrid, ABrickFullOfValuesCountsThemAll) {
    const BrickGrid bricks =
        BrickGrid::from(grid_of(16, 16, 16, CellStatus::value), {1, -32, 0.5F});
    EXPECT_EQ(bricks.view().bricks[0].value_count, 4096);
}

TEST(BrickGrid, CellsBeyondTheEdgeHaveCodeZero) {
    const BrickGrid bricks = BrickGrid::from(grid_of(1, 1, 1, CellStatus::value), {});
    EXPECT_EQ(bricks.view().status(0, 0, 0), CellStatus::value);
    EXPECT_EQ(bricks.view().bricks[0].value_count, 1);
    EXPECT_EQ(bricks.view().status(0, 0, 1), CellStatus::not_seen);
    EXPECT_EQ(bricks.view().status(1, 0, 0), CellStatus::not_seen);
    EXPECT_EQ(bricks.view().status(15, 15, 15), CellStatus::not_seen);
}

TEST(BrickGrid, CellsBeyondTheEdgeDoNotCountAgainstABrickAllAlike) {
    for (const CellStatus status :
         {CellStatus::not_seen, CellStatus::no_echo, CellStatus::range_folded}) {
        Grid grid = grid_of(17, 1, 33, status);
        const BrickGrid alike = BrickGrid::from(grid, {});
        for (const BrickEntry& entry : alike.view().bricks) {
            EXPECT_EQ(entry.kind, BrickKind::uniform);
            EXPECT_EQ(entry.uniform_status, status);
        }
        const auto other = static_cast<CellStatus>((static_cast<int>(status) + 1) % 3);
        grid.status[grid.spec.index(16, 0, 32)] = other;
        const BrickGrid different = BrickGrid::from(grid, {});
        EXPECT_EQ(different.view().bricks.back().uniform_status, other)
            << "the last brick has one cell";
        EXPECT_EQ(to_dense(different.view()).status, grid.status);
    }
}

TEST(BrickGrid, ValuesBeyondTheCodesAreClampedAndCounted) {
    Grid grid = grid_of(4, 1, 1, CellStatus::value);
    grid.values = {-40, 200, -32, std::nanf("")};
    const BrickGrid bricks = BrickGrid::from(grid, {1, -32, 0.5F});
    EXPECT_EQ(bricks.clamped_count(), 3U);
    EXPECT_EQ(bricks.view().value(0, 0, 0), -32);
    EXPECT_EQ(bricks.view().value(1, 0, 0), 94);
    EXPECT_EQ(bricks.view().value(2, 0, 0), -32);
    const BrickGrid derived = BrickGrid::from(grid, {1, -32, 0.5F, true});
    EXPECT_EQ(derived.clamped_count(), 4U);
    EXPECT_EQ(to_dense(derived.view()).status, grid.status) << "no value becomes ambiguous";
    EXPECT_EQ(derived.view().value(0, 0, 0), -31.5F);
}

}  // namespace
}  // namespace stormcellar::grid
