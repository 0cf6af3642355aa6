// cli/shared/cache_domain.h -- which domain of a cache the words of a command line mean.
//
// Threads   Pure functions, which look at the cache.
// Errors    See each function.
#pragma once

#include <string>
#include <vector>

#include "cli/shared/service_places.h"
#include "cli/shared/source_names.h"
#include "stormcellar/base/result.h"
#include "stormcellar/cache/store.h"

namespace stormcellar::cli {

// Sorts words into files and a domain, see tell_apart(); the domains are those of the cache that is
// given, or of the service.
[[nodiscard]] Result<SourceNames> tell_apart_from_cache(const std::vector<std::string>& words,
                                                        const std::string& domain,
                                                        const PlaceOption& cache);

// Names the domain that is meant where none is named: the only one of the cache. Errors: not_found
// for a cache without one, bad_argument, naming them, for one with several.
[[nodiscard]] Status take_only_domain(const cache::StoreReader& store, std::string& domain);

}  // namespace stormcellar::cli
