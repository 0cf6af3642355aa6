// tests/cache/made_grids.h -- small grids for files and stores.
#pragma once

#include "stormcellar/cache/grid_file.h"
#include "stormcellar/cache/store.h"
#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/grid/grid.h"

namespace stormcellar::testing {

// A grid with every kind of brick, small enough to damage byte by byte: 40 x 24 x 18 cells, 3 x 2 x
// 2 bricks. Values, folded, no echo and not seen cells; some bricks are uniform, some hold states
// alone, some are stored.
[[nodiscard]] grid::Grid small_grid();

// Grids of several sizes on disk, made once.
inline constexpr int most_bricks = 8;

inline const UtcTime noon = *parse_utc("2024-11-22T12:00", UtcTime{});

// The name of a grid of reflectivity so many minutes after noon.
[[nodiscard]] inline cache::GridName grid_named(const std::string& domain, int minute) {
    return {domain, level2::Moment::ref, noon + std::chrono::minutes{minute}};
}

// 128 x 16 x 16 cells, of whose 8 bricks `stored` (1 to 8) are stored, every second one first, so
// that runs and holes vary. Of 16-bit codes: 8 KiB a brick.
[[nodiscard]] const grid::BrickGrid& sized_grid(int stored);

// Describes such a grid; `number` goes into its notes, so that files can be told apart.
[[nodiscard]] cache::GridDescription sized_description(UtcTime time, int number = 0);

// Commits such a grid.
[[nodiscard]] Result<std::filesystem::path> commit_sized(cache::StoreWriter& store,
                                                         const std::string& domain, UtcTime time,
                                                         int stored = 4, int number = 0);

// Every grid of a cache, by domain, moment and time.
[[nodiscard]] std::vector<cache::StoreEntry> all_grids(const cache::StoreReader& store);

// "A+5": domain and minutes after noon of each grid.
[[nodiscard]] std::vector<std::string> short_names(const std::vector<cache::StoreEntry>& grids);

// Opens and verifies a grid, and expects the cells of a sized one. Returns "" or what is wrong.
[[nodiscard]] std::string trouble_in(const cache::StoreEntry& entry);

}  // namespace stormcellar::testing
