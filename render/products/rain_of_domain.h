// render/products/rain_of_domain.h -- the rain total of a domain, from its grids in a cache.
//
// A total uses the domain's grids of RATE. If those of REF reach further into its time, it uses
// these, which give rates by reflectivity alone, and a note says so. The volumes before and after
// the span, up to the longest bridge (RainTotal), tell the rates at its ends. Grids with other
// cells than the newest one are left out, so that their minutes are not seen; so are grids that the
// cache evicts meanwhile.
//
// Threads   One thread at a time; work is split over `threads`.
// Errors    See each function.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "render/products/rain_total_grid.h"
#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/cache/store.h"
#include "stormcellar/retrieve/rain_total.h"

namespace stormcellar::render {

[[nodiscard]] retrieve::RainSpan span_ending(UtcTime to, double hours);
// Returns true if a volume with this middle tells a rate of the span.
[[nodiscard]] bool tells_about(const retrieve::RainSpan& span, UtcTime middle);

struct RainOfDomain {
    std::string domain;
    retrieve::RainSpan span;
    std::optional<UtcTime> last = {};  // grids of later times do not count; none: all count
    int threads = 1;
    std::function<bool()> stop = {};  // returns true to give up; may be empty
};

// Returns the grids of which a total may be made, by time. Errors: those of the store.
[[nodiscard]] Result<std::vector<cache::StoreEntry>> rain_entries(const cache::StoreReader& store,
                                                                  const RainOfDomain& wish);

// Returns the total of these grids. Adds to `left_out` the messages of grids that cannot be read.
// Errors: busy if `stop` returns true; those of RainTotalGrid::add().
[[nodiscard]] Result<RainTotalGrid> rain_total_of(const std::vector<cache::StoreEntry>& entries,
                                                  const RainOfDomain& wish,
                                                  std::vector<std::string>* left_out = nullptr);
// Does both.
[[nodiscard]] Result<RainTotalGrid> rain_total_of_domain(
    const cache::StoreReader& store, const RainOfDomain& wish,
    std::vector<std::string>* left_out = nullptr);

}  // namespace stormcellar::render
