// render/frame/frame_cache.h -- keeps the map, the tables and the memory that the frames of a loop
// share.
//
// Pictures have the same pixels with and without the cache.
//
// Threads   One thread at a time.
#pragma once

#include "render/map/map_layer.h"
#include "render/volume/slicer.h"
#include "render/volume/transfer_cache.h"

namespace stormcellar::render {

struct FrameCache {
    MapCache map;
    TransferCache transfer;
    SlicerRoom room;
};

}  // namespace stormcellar::render
