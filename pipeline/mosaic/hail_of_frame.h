// pipeline/mosaic/hail_of_frame.h -- gives a frame of a domain in the cache the hail of its radars,
// merged by maximum (retrieve/hail/hail_mosaic.h).
//
// The cache keeps the partials of which a frame was made, and the frame lists them. So the grid of
// each radar for the instant is made again, and the columns with hail come whole from the radar
// whose hail is largest.
//
// Units     Heights in meters above mean sea level.
// Threads   Functions without state; work is split over `threads`.
// Errors    not_found if the frame lists no partials, or if one of them is no longer in the cache;
//           over_budget for a frame of more cells than `most_cells`; bad_argument for impossible
//           heights; those of reading grids and of make_frame().
#pragma once

#include <string>

#include "pipeline/keep/geometry_cache.h"
#include "stormcellar/base/result.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/cache/store.h"
#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/retrieve/hail.h"

namespace stormcellar::pipeline {

// The notes of a frame whose hail was merged, and of one whose reflectivity was merged first.
inline constexpr const char* merged_hail_note = "hail of several radars, merged by maximum";
inline constexpr const char* merged_reflectivity_note =
    "hail of reflectivity merged from several radars, which may be too small: ";

struct HailRequest {
    std::string domain;
    retrieve::FreezingLevels levels;
    double most_cells = 1e9;  // cells of the frame, of which each takes 9 bytes of memory
    int threads = 1;
};

struct HailFrame {
    cache::GridDescription description;  // with a note
    grid::BrickGrid bricks;
};

// Returns true if the grid was merged from several radars, so that its hail must be merged again.
[[nodiscard]] bool is_of_several(const cache::GridDescription& frame);

// `frame` and `view` are those of a grid of REF for which is_of_several() is true.
[[nodiscard]] Result<HailFrame> hail_of_frame(const cache::StoreReader& store,
                                              const HailRequest& request,
                                              const cache::GridDescription& frame,
                                              const grid::BrickView& view);

}  // namespace stormcellar::pipeline
