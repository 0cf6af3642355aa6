// render/map/coverage.h -- the share of a grid's columns that was seen.
//
// Threads   Plain values and pure functions.
#pragma once

#include <span>
#include <string>

#include "render/products/column_summary.h"
#include "stormcellar/grid/grid_spec.h"

namespace stormcellar::render {

// Shares of all columns, 0..1.
struct Coverage {
    double seen = 0;      // at any level
    double seen_low = 0;  // below low_coverage_m (render/products/ground.h)
};

// Returns the shares, which are 0 if there are no columns. All columns count alike, even if the
// cells of the grid differ in size.
[[nodiscard]] Coverage coverage_of(std::span<const ColumnSummary> columns,
                                   const grid::GridSpec& spec);

// Returns "87 %", or "< 1 %" and "> 99 %" if rounding would give none or all.
[[nodiscard]] std::string percent_text(double share);

}  // namespace stormcellar::render
