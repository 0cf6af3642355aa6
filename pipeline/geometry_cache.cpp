#include "pipeline/geometry_cache.h"

namespace stormcellar::pipeline {
namespace {

bool same_site(const grid::SitePosition& a, const grid::SitePosition& b) {
    return a.latitude_deg == b.latitude_deg && a.longitude_deg == b.longitude_deg &&
           a.altitude_m == b.altitude_m;
}

}  // namespace

std::shared_ptr<const grid::ColumnGeometry> GeometryCache::find(const grid::SitePosition& site,
                                                                const grid::GridSpec& spec,
                                                                grid::FrameKind frame) {
    const std::scoped_lock lock(mutex_);
    for (auto entry = entries_.begin(); entry != entries_.end(); ++entry) {
        if (same_site(entry->site, site) && entry->spec == spec && entry->frame == frame) {
            entries_.splice(entries_.begin(), entries_, entry);
            return entry->geometry;
        }
    }
    return nullptr;
}

Result<std::shared_ptr<const grid::ColumnGeometry>> GeometryCache::get(
    const grid::SitePosition& site, const grid::GridSpec& spec, grid::FrameKind frame) {
    if (auto found = find(site, spec, frame)) return found;
    auto made = grid::make_column_geometry(site, spec, frame);
    if (!made) return made;
    // Another thread may have made the same meanwhile.
    if (auto found = find(site, spec, frame)) return found;
    const std::scoped_lock lock(mutex_);
    entries_.push_front({site, spec, frame, *made});
    if (entries_.size() > capacity_) entries_.pop_back();
    return made;
}

}  // namespace stormcellar::pipeline
