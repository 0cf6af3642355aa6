#include "cli/shared/cache_domain.h"

#include <algorithm>

#include <fmt/ranges.h>

namespace stormcellar::cli {

Result<SourceNames> tell_apart_from_cache(const std::vector<std::string>& words,
                                          const std::string& domain, const PlaceOption& cache) {
    const auto is_domain = [&](const std::string& word) {
        PlaceOption place = cache;
        if (!place.find()) return false;
        const auto store = cache::StoreReader::open(place.directory);
        const auto domains = store ? store->domains() : Result<std::vector<std::string>>{};
        return domains && std::ranges::find(*domains, word) != domains->end();
    };
    return tell_apart(words, domain, is_domain);
}

Status take_only_domain(const cache::StoreReader& store, std::string& domain) {
    const auto domains = store.domains();
    if (!domains) return pass_on(domains);
    if (domains->size() == 1) {
        domain = domains->front();
        return {};
    }
    if (domains->empty()) {
        return fail(ErrorCode::not_found, "{}: the cache is empty", store.directory().native());
    }
    return fail(ErrorCode::bad_argument,
                "name a domain of the cache, or a file: the domains are {}",
                fmt::join(*domains, ", "));
}

}  // namespace stormcellar::cli
