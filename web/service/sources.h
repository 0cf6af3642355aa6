// web/service/sources.h -- what the doors answer from: the catalog, the grids, and the
// configuration.
//
// Threads   Plain data; what it points to may be used by many threads.
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
    // One object for the life of the program: clients hold its numbers.
    std::shared_ptr<TimeNumbers> numbers;
};

// Opens what is there. A cache or a catalog that does not exist yet is no error. Errors: io,
// permission and others of a catalog or cache that is there.
[[nodiscard]] Result<Sources> open_sources(WebSetup setup);

// Returns the doors of everything that [web] serve names, and the index. What they do is counted in
// `measures`, which are those of one server.
[[nodiscard]] std::shared_ptr<const Doors> doors_to(const Sources& sources, Measures& measures);

}  // namespace stormcellar::web
