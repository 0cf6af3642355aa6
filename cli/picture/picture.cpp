#include "cli/picture/picture.h"

#include <algorithm>

#include <fmt/ranges.h>

#include "base/nearest_name.h"
#include "cli/shared/commands.h"

namespace stormcellar::cli {

namespace {

// Returns the moments that the grids of the domain have, at any time.
std::vector<std::string_view> moments_kept(const cache::StoreReader& store,
                                           const std::string& domain) {
    std::vector<std::string_view> kept;
    for (const level2::Moment moment : level2::all_moments) {
        const auto entries = store.list(domain, moment, std::nullopt, std::nullopt);
        if (entries && !entries->empty()) kept.push_back(level2::moment_name(moment));
    }
    return kept;
}

}  // namespace

int report_no_grid(const cache::StoreReader& store, const std::string& domain,
                   level2::Moment moment, const std::string& when) {
    const auto kept = moments_kept(store, domain);
    const std::string_view name = level2::moment_name(moment);
    std::string why;
    if (!kept.empty() && std::find(kept.begin(), kept.end(), name) == kept.end()) {
        why = fmt::format("there is no grid of {} of domain '{}'; its grids are of {}", name,
                          domain, fmt::join(kept, ", "));
    } else {
        const auto domains = store.domains().value_or(std::vector<std::string>{});
        const std::string meant = kept.empty() ? did_you_mean(domain, domains) : std::string{};
        const std::string known =
            domains.empty() ? std::string{"; the cache is empty"}
                            : fmt::format("; the domains are {}", fmt::join(domains, ", "));
        why = fmt::format("there is no grid of domain '{}'{}{}", domain, when,
                          meant.empty() ? known : meant);
    }
    fmt::print(stderr, "stormcellar: {}\n",
               printable(fmt::format("{}: {}", store.directory().native(), why)));
    return exit_nothing_matched;
}

}  // namespace stormcellar::cli
