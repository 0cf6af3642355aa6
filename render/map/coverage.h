// render/map/coverage.h -- computes the share of a grid's columns that was seen.
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

// Returns the shares. They are 0 if there are no columns. All columns count the same, even if the
// cells of the grid differ in size.
[[nodiscard]] Coverage coverage_of(std::span<const ColumnSummary> columns,
                                   const grid::GridSpec& spec);

// Returns a text such as "87 %". If rounding would give none or all, returns "< 1 %" or "> 99 %".
[[nodiscard]] std::string percent_text(double share);

}  // namespace stormcellar::render
