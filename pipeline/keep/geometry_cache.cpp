#include "pipeline/keep/geometry_cache.h"

#include "grid/judge/audit.h"

namespace stormcellar::pipeline {

Result<std::shared_ptr<const grid::ColumnGeometry>> GeometryCache::get(
    const grid::SitePosition& site, const grid::GridSpec& spec, grid::FrameKind frame) {
    const Framed place{{site, spec}, frame};
    if (auto found = geometries_.find(place)) return *found;
    auto made = grid::make_column_geometry(site, spec, frame);
    if (!made) return made;
    return geometries_.keep(place, *std::move(made));
}

std::optional<grid::GridWindow> GeometryCache::window(const grid::GridSpec& domain,
                                                      const grid::SitePosition& site,
                                                      double reach_m) {
    const Reach reach{{site, domain}, reach_m};
    if (const auto found = windows_.find(reach)) return *found;
    return windows_.keep(reach, grid::site_window(domain, site, reach_m));
}

std::shared_ptr<const grid::SiteDistance> GeometryCache::distance(const grid::GridSpec& domain,
                                                                  const grid::GridWindow& window,
                                                                  const grid::SitePosition& site) {
    const Windowed place{{site, domain}, window};
    if (auto found = distances_.find(place)) return *found;
    return distances_.keep(place, std::make_shared<const grid::SiteDistance>(domain, window, site));
}

std::shared_ptr<const grid::SiteColumns> GeometryCache::places(const grid::SitePosition& site,
                                                               const grid::GridSpec& spec) {
    const Place place{site, spec};
    if (auto found = places_.find(place)) return *found;
    return places_.keep(place,
                        std::make_shared<const grid::SiteColumns>(site, spec, grid::audit_reach_m));
}

}  // namespace stormcellar::pipeline
