// tests/cache/made_grids.h -- small grids for files and stores.
#pragma once

#include "stormcellar/cache/grid_file.h"
#include "stormcellar/cache/store.h"
#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/grid/grid.h"

namespace stormcellar::testing {

// Returns a grid with every kind of cell and of brick (uniform, only states, stored). It is small
// enough to damage each byte: 40 x 24 x 18 cells in 3 x 2 x 2 bricks.
[[nodiscard]] grid::Grid small_grid();

// Returns small_grid() as a grid of VELD. Half of its range-folded cells and all cells of the
// bricks in the east are ambiguous.
[[nodiscard]] grid::Grid ambiguous_grid();

// Largest number of stored bricks in a grid of sized_grid().
inline constexpr int most_bricks = 8;

inline const UtcTime noon = *parse_utc("2024-11-22T12:00", UtcTime{});

// Returns the name of a reflectivity grid `minute` minutes after noon.
[[nodiscard]] inline cache::GridName grid_named(const std::string& domain, int minute) {
    return {domain, level2::Moment::ref, noon + std::chrono::minutes{minute}};
}

// Returns a grid of 128 x 16 x 16 cells with 16-bit codes in 8 bricks of 8 KiB. `stored` of the
// bricks (1 to 8) hold codes. Every second brick gets codes first, so that runs and holes vary.
[[nodiscard]] const grid::BrickGrid& sized_grid(int stored);

// Describes a grid of sized_grid(). Its notes contain `number`, so that files can be told apart.
[[nodiscard]] cache::GridDescription sized_description(UtcTime time, int number = 0);

// Commits a grid of sized_grid() with this description.
[[nodiscard]] Result<std::filesystem::path> commit_sized(cache::StoreWriter& store,
                                                         const std::string& domain, UtcTime time,
                                                         int stored = 4, int number = 0);

// Returns all grids of a cache, by domain, moment and time.
[[nodiscard]] std::vector<cache::StoreEntry> all_grids(const cache::StoreReader& store);

// Returns the domain and the minutes after noon of each grid: "A+5".
[[nodiscard]] std::vector<std::string> short_names(const std::vector<cache::StoreEntry>& grids);

// Opens and verifies a grid, and compares its cells with sized_grid(). Returns the fault, or an
// empty text.
[[nodiscard]] std::string trouble_in(const cache::StoreEntry& entry);

}  // namespace stormcellar::testing
