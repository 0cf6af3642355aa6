// cache/evict.h -- evicts grids on request, besides a daemon that writes and evicts as well.
//
// The choice is a list, so it can be shown before anything is evicted. Pinned grids are never
// evicted; a grid that is pinned after it was chosen is kept.
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
    // A grid is evicted if any of these selects it. `to` also selects the newest grids. `bytes` and
    // `older_than` keep the newest grid of each domain that is_known_group() knows
    // (stormcellar/cache/budget.h), however old or large it is. `bytes` selects grids of others
    // first.
    std::optional<UtcTime> to;           // up to and including this time
    std::optional<std::uint64_t> bytes;  // the oldest ones, until the rest takes no more than this
    // this much older than the newest of the same domain
    std::optional<std::chrono::milliseconds> older_than;
};

struct EvictionPlan {
    std::vector<StoreEntry> victims;  // oldest first
    std::size_t looked_at = 0;        // grids of the domain
    std::size_t pinned = 0;           // how many of these are pinned
    std::uint64_t bytes_left = 0;     // on disk, the size of the grids that stay
};
[[nodiscard]] Result<EvictionPlan> plan_eviction(const StoreReader& store,
                                                 const EvictionOrder& order, UtcTime now);

struct EvictionReport {
    std::vector<StoreEntry> evicted;
    std::vector<std::string> problems;  // failed removals, one line each
};
// Evicts the victims. A grid that is reported as evicted stays away after a power cut, unless a
// problem says that its directory could not be synced.
[[nodiscard]] EvictionReport evict(FileSystem& file_system, const std::vector<StoreEntry>& victims);

}  // namespace stormcellar::cache
