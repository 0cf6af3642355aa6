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

// The sites to merge, and the mosaic to fill.
struct MosaicWork {
    const GridSpec& domain;
    const MosaicOptions& options;
    std::span<const PlacedSite> sites;
    const MosaicView* previous = nullptr;  // source of bricks that did not change
    std::vector<bool> changed = {};        // for each column of bricks; empty: all changed
    Mosaic& made;
};

// Fills a mosaic in which no cell is seen yet.
void fill_mosaic(const MosaicWork& work);
// Fills the changed columns of a mosaic anew, and no others. `previous` must be null.
void refill_mosaic(const MosaicWork& work);

}  // namespace stormcellar::grid
