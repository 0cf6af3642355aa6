// tests/fault/aftermath.h -- checks what must be true once a fault is over and the daemon has
// caught up.
//
// Every test of a fault ends with this check, which demands the following. Each file of the drop
// directory is in the catalog exactly once, settled, with a reason if it is not complete. Each
// complete volume has its whole grid in the cache. Every grid opens and verifies, and every
// database is sound. No temporary files are left. The check lists the files and reads the databases
// itself. Of the product's code it uses only code that reads, none that writes. Call the check when
// the daemon has stopped.
//
// Threads   A function without state.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "stormcellar/base/utc_time.h"

namespace stormcellar::fault {

struct Places {
    std::filesystem::path drop, state, cache;
};

enum class Contents {
    whole_volume,  // must be complete, with a whole grid
    part,          // must be partial or rejected with a reason; complete would be wrong
    junk,          // must be rejected with a reason
};

// One volume, or other contents, as written into the drop directory.
struct Delivered {
    std::vector<std::filesystem::path> files;  // absolute; all files of a volume in chunks
    Contents contents = Contents::whole_volume;
    std::string station;          // station of the volume
    std::optional<UtcTime> time;  // start of the volume
};

struct Aftermath {
    std::size_t files = 0;        // delivered files
    std::size_t rows = 0;         // rows of all databases of the catalog
    std::size_t volumes = 0;      // volumes that were delivered whole
    std::size_t gridded = 0;      // those of `volumes` that have a whole grid in the cache
    std::size_t grids = 0;        // grids in the cache, all of them verified
    std::size_t with_reason = 0;  // rows that are partial or rejected and give a reason
    std::size_t set_aside = 0;    // damaged databases that were set aside
    std::vector<std::string> problems;

    [[nodiscard]] bool holds() const { return problems.empty(); }
    // Returns the first twenty problems, one a line.
    [[nodiscard]] std::string problem_text() const;
    // Returns "23 files, 23 rows, ...".
    [[nodiscard]] std::string summary() const;
};

[[nodiscard]] Aftermath look_at_aftermath(const Places& places,
                                          const std::vector<Delivered>& delivered);

}  // namespace stormcellar::fault
