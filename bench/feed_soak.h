// bench/feed_soak.h -- checks after a long run: memory, and whether files, rows and grids agree.
//
// Threads   Pure: may be called from any thread.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "bench/feed_run.h"
#include "stormcellar/base/result.h"

namespace stormcellar::bench {

// Returns the slope of a least-squares line through the samples after the first tenth, in MiB an
// hour. NaN for fewer than two.
[[nodiscard]] double memory_slope_mib_h(std::span<const MemorySample> samples);

struct SoakCheck {
    std::size_t files = 0;          // below the drop directory
    std::size_t rows = 0;           // of the catalog: volumes of whole files, deleted ones included
    std::size_t missing_rows = 0;   // volumes that were sent and have no such row
    std::size_t wrong_rows = 0;     // rows that say "gone" of an existing file, or the reverse
    std::size_t grids = 0;          // in the cache
    std::size_t missing_grids = 0;  // stations whose newest whole volume has no grid
    [[nodiscard]] bool agrees() const { return missing_rows + wrong_rows + missing_grids == 0; }
};
// Call it after the daemon has ended. Errors: those of the catalog and the cache.
[[nodiscard]] Result<SoakCheck> check_soak(const NationalFeed& feed,
                                           const std::vector<int>& volumes_sent,
                                           const DaemonProcess& daemon);

}  // namespace stormcellar::bench
