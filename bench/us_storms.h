// bench/us_storms.h -- the grid of the United States, and what 160 synthetic radars see on it.
//
// Threads   Pure: may be called from any thread.
#pragma once

#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/grid/grid_window.h"
#include "stormcellar/grid/site_distance.h"

namespace stormcellar::bench {

// Returns 7000 x 3500 columns at 0.01 degrees and the 33 levels of MRMS, 0.5 to 19 km.
[[nodiscard]] grid::GridSpec us_grid();

// Returns storms in some 7 % of a site's bricks; sites that see the same place see the same storms.
[[nodiscard]] grid::BrickGrid us_storms(const grid::GridSpec& domain,
                                        const grid::GridWindow& window,
                                        const grid::SiteDistance& distance,
                                        const grid::SitePosition& site);

}  // namespace stormcellar::bench
