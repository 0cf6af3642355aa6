// tests/fault/aftermath.h -- what must be true once a fault is over and the daemon has caught up.
//
// One checker for every fault: each file of the drop directory stands in the catalog exactly once,
// settled, with a reason where it is not complete; each complete volume has its whole grid in the
// cache; every grid opens and verifies; every database is sound; nothing that was made for a while
// is left. Looks at the files itself: of the product it uses readers alone.
// Ask it when the daemon has stopped. Thread contract: a function without state.
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
    whole_volume,  // must be complete, and its grid whole
    part,          // must be partial or rejected with a reason; complete would be a lie
    junk,          // must be rejected with a reason
};

// One volume, or what is none, as it was written into the drop directory.
struct Delivered {
    std::vector<std::filesystem::path> files;  // of chunks all; absolute
    Contents contents = Contents::whole_volume;
    std::string station;          // of volumes
    std::optional<UtcTime> time;  // its start
};

struct Aftermath {
    std::size_t files = 0;        // delivered
    std::size_t rows = 0;         // of the catalog, in all databases
    std::size_t volumes = 0;      // delivered whole
    std::size_t gridded = 0;      // of these, in the cache and whole
    std::size_t grids = 0;        // in the cache, all verified
    std::size_t with_reason = 0;  // rows that are partial or rejected and say why
    std::size_t set_aside = 0;    // damaged databases
    std::vector<std::string> problems;

    [[nodiscard]] bool holds() const { return problems.empty(); }
    // The first twenty, one a line.
    [[nodiscard]] std::string problem_text() const;
    // "23 files, 23 rows, ..."
    [[nodiscard]] std::string summary() const;
};

[[nodiscard]] Aftermath look_at_aftermath(const Places& places,
                                          const std::vector<Delivered>& delivered);

}  // namespace stormcellar::fault
