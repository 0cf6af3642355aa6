// tests/cli/uniform_grid.h -- grids about KBGM that show one value everywhere, for commands to
// draw.
#pragma once

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "stormcellar/cache/store.h"
#include "stormcellar/grid/brick_grid.h"

namespace stormcellar::testing {

// Returns a grid of `cells` rows and columns. The time has the form of file names,
// "20050822_024400".
inline grid::Grid uniform_grid(const std::string& compact_time, float dbz, int cells = 40) {
    grid::Grid grid;
    grid.spec = grid::default_spec(42.2, -75.98);
    grid.spec.nx = grid.spec.ny = cells;
    grid.time = parse_compact(compact_time).value();
    grid.sites = {{"KBGM", 42.2, -75.98, 490}};
    grid.values.assign(grid.spec.cell_count(), dbz);
    grid.status.assign(grid.spec.cell_count(), grid::CellStatus::value);
    return grid;
}

inline std::filesystem::path commit_grid(cache::StoreWriter& store, const grid::Grid& grid) {
    const auto bricks = grid::BrickGrid::from(grid, grid::default_quantization(grid.moment));
    const auto path = store.commit("KBGM", cache::describe(grid), bricks.view());
    EXPECT_TRUE(path) << path.error().message;
    return path ? *path : std::filesystem::path{};
}

}  // namespace stormcellar::testing
