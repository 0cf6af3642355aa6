// grid/mosaic/mosaic_fill.h -- fills the bricks of a mosaic.
//
// Threads: columns of bricks are shared out; the result has the same bits for any number.
#pragma once

#include <span>
#include <vector>

#include "grid/mosaic/mosaic_sites.h"
#include "stormcellar/grid/mosaic.h"

namespace stormcellar::grid {

// What is merged, and into what.
struct MosaicWork {
    const GridSpec& domain;
    const MosaicOptions& options;
    std::span<const PlacedSite> sites;
    const MosaicView* previous = nullptr;  // bricks not changed are copied from it
    std::vector<bool> changed = {};        // of each column of bricks; empty: all
    Mosaic& made;
};

// Fills a mosaic in which nothing was seen so far.
void fill_mosaic(const MosaicWork& work);
// Fills the changed columns of a mosaic anew; the rest of it stays. There is no previous.
void refill_mosaic(const MosaicWork& work);

}  // namespace stormcellar::grid
