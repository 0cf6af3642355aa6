// bench/us_mosaic.h -- one mosaic of the United States from 160 made-up radars, for bench_mosaic.
//
// The grid and the storms: bench/us_storms.h. Partials are grid files of the cache, made once and
// mapped, as the daemon has them; the new volume is a real one, moved to Des Moines.
#pragma once

#include <filesystem>

#include "bench/request.h"
#include "bench/table.h"
#include "stormcellar/base/result.h"

namespace stormcellar::bench {

// A row of bench_merge for each number of threads; `work` has the partials (some 1 GiB) afterward.
[[nodiscard]] Status measure_us(const Request& request, const std::filesystem::path& work,
                                Table& table);

}  // namespace stormcellar::bench
