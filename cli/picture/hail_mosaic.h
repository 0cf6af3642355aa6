// cli/picture/hail_mosaic.h -- makes the grid of a product of hail from files. The hail of several
// radars merges by maximum (retrieve/hail/hail_mosaic.h).
//
// Threads   One thread at a time; work is split over the threads of the options.
// Errors    Those of PictureGrid::make(); bad_argument for impossible heights of 0 and -20 C.
#pragma once

#include "cli/picture/picture_grid.h"
#include "stormcellar/base/result.h"
#include "stormcellar/retrieve/hail.h"

namespace stormcellar::cli {

[[nodiscard]] Result<PictureGrid> hail_grid_of_files(GridOptions options,
                                                     const retrieve::FreezingLevels& levels);

}  // namespace stormcellar::cli
