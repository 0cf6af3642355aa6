// web/data/storms/marked_cells.h -- the storm cells that a picture marks, as `stormcellar frame
// --overlay cells` does.
//
// Cells have MESH only if the request gives freezing levels. Cells with the levels of the
// configuration are kept (StormScans); with others, each request searches its grids again.
//
// Threads   Many threads may use it.
// Errors    not_found if the domain has no grid of reflectivity in the time `storm_recent` before
//           the picture; those of StormScans::track().
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/render/overlays.h"
#include "web/data/storms/storm_scans.h"

namespace stormcellar::web {

struct MarkedCells {
    std::shared_ptr<const render::CellOverlay> overlay;
    std::string key;  // names the grids in which the cells were found
};

[[nodiscard]] Result<MarkedCells> marked_cells(
    StormScans& scans, const std::string& domain, UtcTime time,
    const std::optional<retrieve::FreezingLevels>& levels);

}  // namespace stormcellar::web
