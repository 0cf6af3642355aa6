#include "render/map/coverage.h"

#include <fmt/format.h>

#include "render/products/ground.h"

namespace stormcellar::render {

Coverage coverage_of(std::span<const ColumnSummary> columns, const grid::GridSpec& spec) {
    std::size_t seen = 0;
    std::size_t low = 0;
    for (const ColumnSummary& column : columns) {
        if (column.lowest_seen == ColumnSummary::never) continue;
        ++seen;
        if (spec.levels_m[column.lowest_seen] < low_coverage_m) ++low;
    }
    if (columns.empty()) return {};
    const auto all = static_cast<double>(columns.size());
    return {static_cast<double>(seen) / all, static_cast<double>(low) / all};
}

std::string percent_text(double share) {
    if (share > 0 && share < 0.01) return "< 1 %";
    if (share < 1 && share > 0.99) return "> 99 %";
    return fmt::format("{:.0f} %", 100 * share);
}

}  // namespace stormcellar::render
