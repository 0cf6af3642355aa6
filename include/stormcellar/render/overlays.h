// stormcellar/render/overlays.h -- what is drawn over a picture besides its map: columns of
// rotation, and marks of storm cells.
//
// Units     As in stormcellar/retrieve/storm_cells.h.
// Threads   Plain data.
#pragma once

#include <cstddef>

#include "stormcellar/grid/brick_view.h"
#include "stormcellar/retrieve/storm_cells.h"

namespace stormcellar::render {

// The storm cells of the newest volume at or before a picture.
struct CellOverlay {
    retrieve::TrackedScan scan;
    retrieve::CellOptions method;  // by which the cells were found
    std::size_t volumes = 1;       // through which the cells were followed
};

// Null: not drawn. The referenced objects must outlive the picture's drawing.
struct Overlays {
    const grid::BrickView* rotation = nullptr;  // over a volume; on the grid of the picture
    const CellOverlay* cells = nullptr;         // over a map or a volume
};

}  // namespace stormcellar::render
