// bench/nation.h -- times a mosaic of the United States from 160 synthetic radars, and its update
// by a new volume.
//
// The grid has 7000 x 3500 columns at 0.01 degrees and the 33 levels of MRMS, 0.5 to 19 km. Storms
// are in some 7 % of a site's bricks; all sites that see a place see the same storms there.
// Partials are grid files of the cache, made once (some 1 GiB) and mapped, as in the daemon. The
// new volume is the real volume KLOT 2022-03-17, moved to Des Moines.
//
// Threads   One thread at a time, because the clocks measure the whole process.
#pragma once

#include <filesystem>
#include <optional>

#include "bench/request.h"
#include "bench/table.h"
#include "stormcellar/base/result.h"

namespace stormcellar::bench {

// Adds a row for each number of threads (bench_mosaic.cpp has the columns). `work` keeps the
// partials. If `cache` is given, the mosaic is committed to it as the domain US, so that the mosaic
// can be drawn.
[[nodiscard]] Status measure_nation(const Request& request, const std::filesystem::path& work,
                                    const std::optional<std::filesystem::path>& cache,
                                    Table& table);

}  // namespace stormcellar::bench
