#include "pipeline/keep/geometry_cache.h"

#include <utility>

#include "grid/judge/audit.h"

namespace stormcellar::pipeline {

template <class Key, class Value, class Make>
Value GeometryCache::find_or_make(RecentlyUsed<Key, Value>& kept, const Key& key,
                                  const Make& make) {
    {
        const std::scoped_lock lock(mutex_);
        if (const Value* found = kept.find(key)) return *found;
    }
    Value made = make();
    const std::scoped_lock lock(mutex_);
    // Another thread may have made it meanwhile.
    if (const Value* found = kept.find(key)) return *found;
    return kept.keep(key, std::move(made));
}

Result<std::shared_ptr<const grid::ColumnGeometry>> GeometryCache::get(
    const grid::SitePosition& site, const grid::GridSpec& spec, grid::FrameKind frame) {
    const Framed place{{site, spec}, frame};
    {
        const std::scoped_lock lock(mutex_);
        if (const auto* found = geometries_.find(place)) return *found;
    }
    auto made = grid::make_column_geometry(site, spec, frame);
    if (!made) return made;
    return find_or_make(geometries_, place, [&] { return *made; });
}

std::optional<grid::GridWindow> GeometryCache::window(const grid::GridSpec& domain,
                                                      const grid::SitePosition& site,
                                                      double reach_m) {
    return find_or_make(windows_, Reach{{site, domain}, reach_m},
                        [&] { return grid::site_window(domain, site, reach_m); });
}

std::shared_ptr<const grid::SiteDistance> GeometryCache::distance(const grid::GridSpec& domain,
                                                                  const grid::GridWindow& window,
                                                                  const grid::SitePosition& site) {
    return find_or_make(distances_, Windowed{{site, domain}, window}, [&] {
        return std::make_shared<const grid::SiteDistance>(domain, window, site);
    });
}

std::shared_ptr<const grid::SiteColumns> GeometryCache::places(const grid::SitePosition& site,
                                                               const grid::GridSpec& spec) {
    return find_or_make(places_, Place{site, spec}, [&] {
        return std::make_shared<const grid::SiteColumns>(site, spec, grid::audit_reach_m);
    });
}

}  // namespace stormcellar::pipeline
