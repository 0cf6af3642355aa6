// cli/shared/cache_domain.h -- finds which domain of a cache a command line means.
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

// Sorts words into files and a domain as tell_apart() does. The domains are those of the given
// cache, else of the service's cache.
[[nodiscard]] Result<SourceNames> tell_apart_from_cache(const std::vector<std::string>& words,
                                                        const std::string& domain,
                                                        const PlaceOption& cache);

// If no domain is named, takes the only one of the cache. Errors: not_found for a cache without
// domains; bad_argument, naming them, for several.
[[nodiscard]] Status take_only_domain(const cache::StoreReader& store, std::string& domain);

}  // namespace stormcellar::cli
