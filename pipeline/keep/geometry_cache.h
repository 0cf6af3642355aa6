// pipeline/keep/geometry_cache.h -- keeps geometry that the volumes of one site use on one grid.
//
// Making a geometry takes longer than using it. When the cache is full, the least recently used
// geometry is dropped.
//
// Threads   Many threads may use one cache. If two threads want the same geometry at the same time,
//           both may make it; the first result is kept.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <utility>

#include "base/recently_used.h"
#include "grid/place/site_columns.h"
#include "stormcellar/base/mutex.h"
#include "stormcellar/base/result.h"
#include "stormcellar/grid/grid_window.h"
#include "stormcellar/grid/gridder.h"
#include "stormcellar/grid/site_distance.h"

namespace stormcellar::pipeline {

class GeometryCache {
  public:
    // `capacity` is the number of column geometries, which are large. Other entries take only some
    // 0.1 MiB each, so more of them are kept.
    explicit GeometryCache(std::size_t capacity) : geometries_(capacity) {}

    Result<std::shared_ptr<const grid::ColumnGeometry>> get(
        const grid::SitePosition& site, const grid::GridSpec& spec,
        grid::FrameKind frame = grid::FrameKind::table);
    // Returns grid::site_window().
    std::optional<grid::GridWindow> window(const grid::GridSpec& domain,
                                           const grid::SitePosition& site, double reach_m);
    // Returns the distances of the window's columns from the site, for merging.
    std::shared_ptr<const grid::SiteDistance> distance(const grid::GridSpec& domain,
                                                       const grid::GridWindow& window,
                                                       const grid::SitePosition& site);
    // Returns the columns of the site for audits (grid::audit_reach_m).
    std::shared_ptr<const grid::SiteColumns> places(const grid::SitePosition& site,
                                                    const grid::GridSpec& spec);

  private:
    static constexpr std::size_t small_ones = 512;

    // The position of a site on a grid. The name of the site does not matter.
    struct Place {
        grid::SitePosition site;
        grid::GridSpec spec;
        bool operator==(const Place& other) const {
            return site.latitude_deg == other.site.latitude_deg &&
                   site.longitude_deg == other.site.longitude_deg &&
                   site.altitude_m == other.site.altitude_m && spec == other.spec;
        }
    };
    struct Framed {
        Place place;
        grid::FrameKind frame = grid::FrameKind::table;
        bool operator==(const Framed&) const = default;
    };
    struct Reach {
        Place place;
        double reach_m = 0;
        bool operator==(const Reach&) const = default;
    };
    struct Windowed {
        Place place;
        grid::GridWindow window;
        bool operator==(const Windowed&) const = default;
    };

    // Values that many threads share.
    template <class Key, class Value>
    class Kept {
      public:
        explicit Kept(std::size_t most) : values_({.values = most}) {}
        std::optional<Value> find(const Key& key) {
            const MutexLock lock(mutex_);
            const Value* found = values_.find(key);
            if (found == nullptr) return std::nullopt;
            // The value itself may be an optional, so construct in place.
            return std::optional<Value>(std::in_place, *found);
        }
        // Keeps the value and returns it. If another thread has kept a value meanwhile, returns
        // that value.
        Value keep(const Key& key, Value value) {
            const MutexLock lock(mutex_);
            if (const Value* found = values_.find(key)) return *found;
            return values_.keep(key, std::move(value));
        }

      private:
        Mutex mutex_;
        RecentlyUsed<Key, Value> values_ STORMCELLAR_GUARDED_BY(mutex_);
    };

    Kept<Framed, std::shared_ptr<const grid::ColumnGeometry>> geometries_;
    Kept<Reach, std::optional<grid::GridWindow>> windows_{small_ones};
    Kept<Windowed, std::shared_ptr<const grid::SiteDistance>> distances_{small_ones};
    Kept<Place, std::shared_ptr<const grid::SiteColumns>> places_{small_ones};
};

}  // namespace stormcellar::pipeline
