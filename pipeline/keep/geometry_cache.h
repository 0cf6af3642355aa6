// pipeline/keep/geometry_cache.h -- what the volumes of one site on one grid share, made once.
//
// Making it takes longer than using it. The least recently used entries are dropped first. Thread
// contract: many threads may use it. If two threads want the same entry at once, both may make it,
// and one result is kept.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "base/recently_used.h"
#include "grid/place/site_columns.h"
#include "stormcellar/base/result.h"
#include "stormcellar/grid/grid_window.h"
#include "stormcellar/grid/gridder.h"
#include "stormcellar/grid/site_distance.h"

namespace stormcellar::pipeline {

class GeometryCache {
  public:
    // For column geometries, which are large. The other entries take some 0.1 MiB each, so more of
    // them are held.
    explicit GeometryCache(std::size_t capacity)
        : geometries_(capacity),
          windows_(small_ones),
          distances_(small_ones),
          places_(small_ones) {}

    Result<std::shared_ptr<const grid::ColumnGeometry>> get(
        const grid::SitePosition& site, const grid::GridSpec& spec,
        grid::FrameKind frame = grid::FrameKind::table);
    // grid::site_window().
    std::optional<grid::GridWindow> window(const grid::GridSpec& domain,
                                           const grid::SitePosition& site, double reach_m);
    // For merging: the geometry of a window of the domain.
    std::shared_ptr<const grid::SiteDistance> distance(const grid::GridSpec& domain,
                                                       const grid::GridWindow& window,
                                                       const grid::SitePosition& site);
    // For audits (grid::audit_reach_m).
    std::shared_ptr<const grid::SiteColumns> places(const grid::SitePosition& site,
                                                    const grid::GridSpec& spec);

  private:
    static constexpr std::size_t small_ones = 512;

    // The position of a site on a grid, whatever the site's name.
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

    RecentlyUsed<Framed, std::shared_ptr<const grid::ColumnGeometry>> geometries_;
    RecentlyUsed<Reach, std::optional<grid::GridWindow>> windows_;
    RecentlyUsed<Windowed, std::shared_ptr<const grid::SiteDistance>> distances_;
    RecentlyUsed<Place, std::shared_ptr<const grid::SiteColumns>> places_;
};

}  // namespace stormcellar::pipeline
