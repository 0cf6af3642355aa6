// render/map/coverage.h -- how much of a grid's columns was seen.
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

// 0 and 0 for no columns. Columns count alike, also where the grid's cells differ in size.
[[nodiscard]] Coverage coverage_of(std::span<const ColumnSummary> columns,
                                   const grid::GridSpec& spec);

// "87 %"; "< 1 %" and "> 99 %" where rounding would say none or all.
[[nodiscard]] std::string percent_text(double share);

}  // namespace stormcellar::render
