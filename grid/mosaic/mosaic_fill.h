// grid/mosaic/mosaic_fill.h -- fills the bricks of a mosaic.
//
// Threads   The threads share the columns of bricks. The result has the same bits for any number of
//           threads.
#pragma once

#include <span>
#include <vector>

#include "grid/mosaic/mosaic_sites.h"
#include "stormcellar/grid/mosaic.h"

namespace stormcellar::grid {

// The sites to merge, and the mosaic to fill.
struct MosaicWork {
    const GridSpec& domain;
    const MosaicOptions& options;
    std::span<const PlacedSite> sites;
    const MosaicView* previous = nullptr;  // has the bricks that did not change
    std::vector<bool> changed = {};        // for each column of bricks; empty: all have changed
    Mosaic& made;
};

// Fills a mosaic. No cell of it may be seen yet.
void fill_mosaic(const MosaicWork& work);
// Fills only the changed columns of bricks anew. `previous` must be null.
void refill_mosaic(const MosaicWork& work);

}  // namespace stormcellar::grid
