// pipeline/drop/station_place.h -- where a station of a catalog stands.
//
// Thread contract: a function without state; the catalog is only read.
#pragma once

#include <optional>
#include <string>

#include "stormcellar/catalog/catalog.h"
#include "stormcellar/grid/grid.h"

namespace stormcellar::pipeline {

// By the station table, else by what its newest raw files say that can still be read. None where
// neither says it.
[[nodiscard]] std::optional<grid::SitePosition> place_of_station(
    const catalog::CatalogReader& catalog, const std::string& icao);

}  // namespace stormcellar::pipeline
