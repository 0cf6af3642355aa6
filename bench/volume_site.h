// bench/volume_site.h -- the position of the antenna of a decoded volume.
#pragma once

#include "stormcellar/base/result.h"
#include "stormcellar/grid/grid.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::bench {

// Returns the position in the volume; else (message 1 has none) that of the station table; else
// not_found.
[[nodiscard]] Result<grid::SitePosition> site_of(const level2::Volume& volume);

}  // namespace stormcellar::bench
