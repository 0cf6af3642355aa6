// cache/evict.h -- evicts grids on request, even while a daemon writes and evicts other grids.
//
// plan_eviction() returns a list of grids, which can be shown before evict() is called. Pinned
// grids are never evicted, even if they are pinned after they were chosen.
//
// Threads   Any thread, any process.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "stormcellar/base/file_system.h"
#include "stormcellar/base/result.h"
#include "stormcellar/cache/store.h"

namespace stormcellar::cache {

struct EvictionOrder {
    std::string domain;  // a domain with its parts, or one part; empty: all domains
    // Each member below chooses grids, and a grid is chosen if any member chooses it. `to` also
    // chooses newest grids. `bytes` and `older_than` spare the newest grid of each domain and
    // moment if is_known_group() (stormcellar/cache/budget.h) is true for its group, however old or
    // large the grid is. But `older_than` may choose the newest grid of a part (NAME.ICAO). `bytes`
    // chooses grids of unknown groups first.
    std::optional<UtcTime> to;           // grids up to and including this time
    std::optional<std::uint64_t> bytes;  // the oldest grids, until at most this is left
    // Grids that are older than the newest grid of their group by more than this.
    std::optional<std::chrono::milliseconds> older_than;
};

struct EvictionPlan {
    std::vector<StoreEntry> victims;  // oldest first
    std::size_t looked_at = 0;        // number of grids in the requested domains
    std::size_t pinned = 0;           // how many of these grids are pinned
    std::uint64_t bytes_left = 0;     // size on disk of the grids that stay
};
[[nodiscard]] Result<EvictionPlan> plan_eviction(const StoreReader& store,
                                                 const EvictionOrder& order, UtcTime now);

struct EvictionReport {
    std::vector<StoreEntry> evicted;
    std::vector<std::string> problems;  // failed removals, one line each
};
// Evicts the victims. Leaves out pinned and missing grids. After a power cut, a grid that is
// reported as evicted does not come back, unless a problem says that its directory could not be
// synced.
[[nodiscard]] EvictionReport evict(FileSystem& file_system, const std::vector<StoreEntry>& victims);

}  // namespace stormcellar::cache
