// bench/us_mosaic.h -- one mosaic of the United States from 160 synthetic radars, for bench_mosaic.
//
// bench/us_storms.h describes the grid and the storms. Partials are grid files of the cache, made
// once and mapped, as in the daemon. The new volume is a real one, moved to Des Moines.
#pragma once

#include <filesystem>

#include "bench/request.h"
#include "bench/table.h"
#include "stormcellar/base/result.h"
#include "stormcellar/grid/brick_grid.h"

namespace stormcellar::bench {

// Measures a row of bench_merge for each number of threads. Afterward `work` contains the partials
// (some 1 GiB).
[[nodiscard]] Status measure_us(const Request& request, const std::filesystem::path& work,
                                Table& table);

// Returns the mosaic of all synthetic radars, made in memory: some 2 GiB while it works.
[[nodiscard]] Result<grid::BrickGrid> us_mosaic();

}  // namespace stormcellar::bench
