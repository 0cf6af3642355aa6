// web/service/sources.h -- the sources from which the doors answer: the catalog, the grids, and the
// configuration.
//
// Threads   Plain data; many threads may use the objects behind the pointers.
#pragma once

#include <memory>

#include "stormcellar/catalog/catalog.h"
#include "web/config/web_setup.h"
#include "web/data/grids/grids.h"
#include "web/data/zarr/time_numbers.h"
#include "web/http/door.h"
#include "web/service/measures.h"

namespace stormcellar::web {

struct Sources {
    WebSetup setup;
    // Null as long as there is no catalog.
    std::shared_ptr<const catalog::CatalogReader> catalog;
    std::shared_ptr<Grids> grids;
    // One object as long as the program runs, because clients hold its numbers.
    std::shared_ptr<TimeNumbers> numbers;
};

// Opens the sources that exist. It is no error if a cache or a catalog does not exist yet. Errors:
// io, permission and others for a catalog or cache that exists.
[[nodiscard]] Result<Sources> open_sources(WebSetup setup);

// Returns a door for each part in `serve` of [web], and for the index. The doors count in
// `measures`, which belong to one server.
[[nodiscard]] std::shared_ptr<const Doors> doors_to(const Sources& sources, Measures& measures);

}  // namespace stormcellar::web
