// cache/evict.h -- evicts grids on request, even while a daemon writes and evicts.
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
    std::string domain;  // a domain with its parts, or a single part; empty: all
    // A grid is chosen if any of these members chooses it. `to` also chooses the newest grids.
    // `bytes` and `older_than` keep the newest grid of each domain and moment in a group that
    // is_known_group() knows (stormcellar/cache/budget.h), however old or large it is. But
    // `older_than` may choose the newest grid of a part (NAME.ICAO). `bytes` chooses grids of
    // others first.
    std::optional<UtcTime> to;           // up to and including this time
    std::optional<std::uint64_t> bytes;  // the oldest, until the remaining grids take at most this
    // Grids that are older than the newest grid of their group by more than this.
    std::optional<std::chrono::milliseconds> older_than;
};

struct EvictionPlan {
    std::vector<StoreEntry> victims;  // oldest first
    std::size_t looked_at = 0;        // grids of the requested domains
    std::size_t pinned = 0;           // pinned grids among them
    std::uint64_t bytes_left = 0;     // size on disk of the grids that stay
};
[[nodiscard]] Result<EvictionPlan> plan_eviction(const StoreReader& store,
                                                 const EvictionOrder& order, UtcTime now);

struct EvictionReport {
    std::vector<StoreEntry> evicted;
    std::vector<std::string> problems;  // failed removals, one line each
};
// Evicts the victims. Leaves out pinned and missing grids. A power cut does not bring back a grid
// that is reported as evicted, unless a problem says that its directory could not be synced.
[[nodiscard]] EvictionReport evict(FileSystem& file_system, const std::vector<StoreEntry>& victims);

}  // namespace stormcellar::cache
