// pipeline/mosaic/instant_cache.h -- keeps in memory grids that were made for an instant from the
// volumes of one site.
//
// A frame is made again for each volume of any of its sites, and making a site's grid for the
// instant takes longer than all merging. So the grids of sites whose volumes have not changed are
// taken from this cache. Beyond a limit of bytes, the least recently used grids are dropped.
//
// Threads   Many threads may use one cache. If two threads want the same grid at the same time,
//           both may make it; one of the two is kept.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "base/recently_used.h"
#include "stormcellar/base/mutex.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/grid/brick_grid.h"

namespace stormcellar::pipeline {

class InstantCache {
  public:
    // Everything on which the cells depend (pipeline/mosaic/frame_parts.h).
    struct Key {
        std::uint64_t before = 0, after = 0;  // fingerprints of the two partials
        std::uint64_t recipe = 0;
        UtcTime instant;
        // NOLINTNEXTLINE(modernize-use-nullptr): clang-tidy 14 takes a defaulted <=> for a null.
        auto operator<=>(const Key&) const = default;
    };

    explicit InstantCache(std::size_t most_bytes)
        : most_bytes_(most_bytes), kept_({.weight = most_bytes}) {}

    // Returns the grid if it is kept, else null.
    [[nodiscard]] std::shared_ptr<const grid::BrickGrid> find(const Key& key);
    void keep(const Key& key, std::shared_ptr<const grid::BrickGrid> made);
    [[nodiscard]] std::size_t bytes() const;

  private:
    std::size_t most_bytes_;
    mutable Mutex mutex_;
    RecentlyUsed<Key, std::shared_ptr<const grid::BrickGrid>> kept_ STORMCELLAR_GUARDED_BY(mutex_);
};

}  // namespace stormcellar::pipeline
