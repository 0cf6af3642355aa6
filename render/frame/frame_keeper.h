// render/frame/frame_keeper.h -- what the frames of a loop share, so that it is made only once.
//
// The pixels are the same with and without it.
//
// Threads   One thread at a time.
#pragma once

#include "render/map/map_layer.h"
#include "render/volume/slicer.h"
#include "render/volume/transfer_keeper.h"

namespace stormcellar::render {

struct FrameKeeper {
    MapKeeper map;
    TransferKeeper transfer;
    SlicerRoom room;
};

}  // namespace stormcellar::render
