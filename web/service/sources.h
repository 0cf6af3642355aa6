// web/service/sources.h -- the sources of the doors' answers: the catalog, the grids, and the
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
    // Null while there is no catalog.
    std::shared_ptr<const catalog::CatalogReader> catalog;
    std::shared_ptr<Grids> grids;
    // One object for the life of the program, because clients hold its numbers.
    std::shared_ptr<TimeNumbers> numbers;
};

// Opens the sources that exist. A cache or a catalog that does not exist yet is no error. Errors:
// io, permission and others of a catalog or cache that exists.
[[nodiscard]] Result<Sources> open_sources(WebSetup setup);

// Returns the doors for all parts in `serve` of [web], and for the index. They count in `measures`,
// which belong to one server.
[[nodiscard]] std::shared_ptr<const Doors> doors_to(const Sources& sources, Measures& measures);

}  // namespace stormcellar::web
