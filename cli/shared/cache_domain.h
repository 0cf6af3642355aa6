// cli/shared/cache_domain.h -- finds the domain of a cache that a command line names.
//
// Threads   Pure functions, except that they read the cache.
// Errors    See each function.
#pragma once

#include <string>
#include <vector>

#include "cli/shared/service_places.h"
#include "cli/shared/source_names.h"
#include "stormcellar/base/result.h"
#include "stormcellar/cache/store.h"

namespace stormcellar::cli {

// Sorts words into files and a domain, as tell_apart() does. Looks for the domain in the given
// cache, else in the service's cache.
[[nodiscard]] Result<SourceNames> tell_apart_from_cache(const std::vector<std::string>& words,
                                                        const std::string& domain,
                                                        const PlaceOption& cache);

// If no domain is named, takes the cache's only domain. Errors: not_found if the cache has no
// domains; bad_argument, naming them, if it has several.
[[nodiscard]] Status take_only_domain(const cache::StoreReader& store, std::string& domain);

}  // namespace stormcellar::cli
