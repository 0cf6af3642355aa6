// pipeline/geometry_cache.h -- column geometries that were made before, by site, spec and frame.
//
// Making one takes longer than using it, and a site's volumes all share it. The least recently
// used go first. Thread contract: may be used by many threads; a geometry that two threads want at
// once may be made twice, and one of the two is kept.
#pragma once

#include <cstddef>
#include <list>
#include <memory>
#include <mutex>

#include "base/result.h"
#include "grid/gridder.h"

namespace stormcellar::pipeline {

class GeometryCache {
  public:
    explicit GeometryCache(std::size_t capacity) : capacity_(capacity) {}

    Result<std::shared_ptr<const grid::ColumnGeometry>> get(
        const grid::SitePosition& site, const grid::GridSpec& spec,
        grid::FrameKind frame = grid::FrameKind::table);

  private:
    struct Entry {
        grid::SitePosition site;
        grid::GridSpec spec;
        grid::FrameKind frame = grid::FrameKind::table;
        std::shared_ptr<const grid::ColumnGeometry> geometry;
    };
    std::shared_ptr<const grid::ColumnGeometry> find(const grid::SitePosition& site,
                                                     const grid::GridSpec& spec,
                                                     grid::FrameKind frame);

    std::size_t capacity_;
    std::mutex mutex_;          // guards entries_
    std::list<Entry> entries_;  // most recently used first
};

}  // namespace stormcellar::pipeline
