// grid/mosaic/mosaic_fill.h -- fills the bricks of a mosaic.
//
// Threads   The threads divide the columns of bricks among themselves. The result has the same bits
//           for any number of threads.
#pragma once

#include <span>
#include <vector>

#include "grid/mosaic/mosaic_sites.h"
#include "stormcellar/grid/mosaic.h"

namespace stormcellar::grid {

// The sites to merge, and the mosaic that they go into.
struct MosaicWork {
    const GridSpec& domain;
    const MosaicOptions& options;
    std::span<const PlacedSite> sites;
    const MosaicView* previous = nullptr;  // bricks that did not change are copied from it
    std::vector<bool> changed = {};        // for each column of bricks; empty: all changed
    Mosaic& made;
};

// Fills a mosaic in which nothing has been seen so far.
void fill_mosaic(const MosaicWork& work);
// Fills the changed columns of a mosaic anew and leaves the rest as it is. `previous` must be null.
void refill_mosaic(const MosaicWork& work);

}  // namespace stormcellar::grid
