// bench/volume_site.h -- where a decoded volume's antenna stands.
#pragma once

#include "stormcellar/base/result.h"
#include "stormcellar/grid/grid.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::bench {

// As the volume says, else (message 1 says nothing) as the station table does; else not_found.
[[nodiscard]] Result<grid::SitePosition> site_of(const level2::Volume& volume);

}  // namespace stormcellar::bench
