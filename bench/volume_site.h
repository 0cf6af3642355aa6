// bench/volume_site.h -- where a decoded volume's antenna stands.
#pragma once

#include "base/result.h"
#include "grid/grid.h"
#include "level2/volume.h"

namespace stormcellar::bench {

// As the volume says, else (message 1 says nothing) as the station table does; else not_found.
[[nodiscard]] Result<grid::SitePosition> site_of(const level2::Volume& volume);

}  // namespace stormcellar::bench
