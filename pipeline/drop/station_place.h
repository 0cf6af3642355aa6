// pipeline/drop/station_place.h -- finds the position of a cataloged station.
//
// Threads   A function without state; the catalog is only read.
#pragma once

#include <optional>
#include <string>

#include "stormcellar/catalog/catalog.h"
#include "stormcellar/grid/grid.h"

namespace stormcellar::pipeline {

// Returns the position of a station from the station table, or else from its newest four files that
// are not gone. Returns none if neither the table nor these files have a position.
[[nodiscard]] std::optional<grid::SitePosition> place_of_station(
    const catalog::CatalogReader& catalog, const std::string& icao);

}  // namespace stormcellar::pipeline
