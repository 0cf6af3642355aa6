#include "render/products/rain_of_domain.h"

#include <algorithm>
#include <chrono>
#include <ratio>
#include <utility>

#include "stormcellar/cache/grid_file.h"

namespace stormcellar::render {
namespace {

using retrieve::RainSpan;
using retrieve::RainTotal;

// No volume takes longer. The store lists grids by the start of their volumes, so the list begins
// this much earlier.
constexpr std::chrono::minutes longest_volume{30};
constexpr const char* reflectivity_note =
    "rain rates by reflectivity alone, because the cache has no grids of rain rates";

}  // namespace

RainSpan span_ending(UtcTime to, double hours) {
    const std::chrono::duration<double, std::ratio<3600>> length(hours);
    return {to - std::chrono::duration_cast<UtcTime::duration>(length), to};
}

bool tells_about(const RainSpan& span, UtcTime middle) {
    return middle >= span.from - RainTotal::longest_bridge &&
           middle <= span.to + RainTotal::longest_bridge;
}

Result<std::vector<cache::StoreEntry>> rain_entries(const cache::StoreReader& store,
                                                    const RainOfDomain& wish) {
    const RainSpan& span = wish.span;
    const UtcTime from = span.from - RainTotal::longest_bridge - longest_volume;
    UtcTime to = span.to + RainTotal::longest_bridge;
    if (wish.last) to = std::min(to, *wish.last);
    auto rates = store.list(wish.domain, level2::Moment::rate, from, to);
    if (!rates) return rates;
    auto reflectivities = store.list(wish.domain, level2::Moment::ref, from, to);
    if (!reflectivities || reflectivities->empty()) return rates;
    const UtcTime begin = std::max(reflectivities->front().time, span.from);
    const UtcTime end = std::min(reflectivities->back().time, span.to);
    const bool is_covered = !rates->empty() &&
                            rates->front().time <= begin + RainTotal::longest_bridge &&
                            rates->back().time >= end - RainTotal::longest_bridge;
    return is_covered ? rates : reflectivities;
}

Result<RainTotalGrid> rain_total_of(const std::vector<cache::StoreEntry>& entries,
                                    const RainOfDomain& wish, std::vector<std::string>* left_out) {
    RainTotalGrid total(wish.span);
    std::optional<grid::GridSpec> cells;
    if (!entries.empty()) {
        const auto newest = cache::GridFile::open(entries.back().path);
        if (!newest) return pass_on(newest);
        cells = newest->description().spec;
    }
    for (const cache::StoreEntry& entry : entries) {
        if (wish.stop && wish.stop())
            return fail(ErrorCode::busy, "the rain total is no longer wanted");
        const auto file = cache::GridFile::open(entry.path);
        if (!file) {
            // The cache may have evicted the grid meanwhile. Its minutes count as not seen.
            if (file.error().code != ErrorCode::not_found && left_out != nullptr)
                left_out->push_back(file.error().message);
            continue;
        }
        cache::GridDescription description = file->description();
        if (!(description.spec == *cells) || !tells_about(wish.span, middle_of(description)))
            continue;
        const grid::BrickGrid lowest =
            retrieve::lowest_rates(file->view(), entry.moment, wish.threads);
        if (Status whole = file->check_whole(); !whole) return pass_on(whole);
        if (entry.moment == level2::Moment::ref)
            description.provenance.notes.emplace_back(reflectivity_note);
        const Status added = total.add(lowest.view(), description, wish.threads);
        if (!added) return pass_on(added);
    }
    total.close();
    return total;
}

Result<RainTotalGrid> rain_total_of_domain(const cache::StoreReader& store,
                                           const RainOfDomain& wish,
                                           std::vector<std::string>* left_out) {
    const auto entries = rain_entries(store, wish);
    if (!entries) return pass_on(entries);
    return rain_total_of(*entries, wish, left_out);
}

}  // namespace stormcellar::render
