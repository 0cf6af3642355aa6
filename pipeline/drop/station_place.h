// pipeline/drop/station_place.h -- the position of a station of a catalog.
//
// Threads   A function without state; the catalog is only read.
#pragma once

#include <optional>
#include <string>

#include "stormcellar/catalog/catalog.h"
#include "stormcellar/grid/grid.h"

namespace stormcellar::pipeline {

// Returns the position from the station table, else from the newest raw files that can still be
// read. None if neither has it.
[[nodiscard]] std::optional<grid::SitePosition> place_of_station(
    const catalog::CatalogReader& catalog, const std::string& icao);

}  // namespace stormcellar::pipeline
