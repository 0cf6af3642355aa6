// pipeline/drop/station_place.h -- the position of a cataloged station.
//
// Thread contract: a function without state that only reads the catalog.
#pragma once

#include <optional>
#include <string>

#include "stormcellar/catalog/catalog.h"
#include "stormcellar/grid/grid.h"

namespace stormcellar::pipeline {

// From the station table, or else from the newest raw files that can still be read. None if neither
// gives it.
[[nodiscard]] std::optional<grid::SitePosition> place_of_station(
    const catalog::CatalogReader& catalog, const std::string& icao);

}  // namespace stormcellar::pipeline
