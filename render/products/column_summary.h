// render/products/column_summary.h -- each column of a grid in three numbers.
//
// What 2D products and the ground of the 3D view need: how far down the column was seen, its
// highest value, and which states it holds.
#pragma once

#include <cstdint>
#include <vector>

#include "stormcellar/grid/brick_view.h"

namespace stormcellar::render {

struct ColumnSummary {
    static constexpr std::uint16_t never = 0xFFFF;
    std::uint16_t lowest_seen = never;  // level: the lowest cell that is not "not seen"
    std::uint16_t max_code = 0;         // of the cells with a value; 0: none
    bool has_no_echo = false;
    bool has_range_folded = false;

    // The state of the column maximum: a value if any cell has one; else range folded if any cell
    // is (what is under it is unknown); else no echo if any cell was seen.
    [[nodiscard]] grid::CellStatus status() const;
};

// One for each column, west to east in rows from south to north. The same result for any number
// of threads.
[[nodiscard]] std::vector<ColumnSummary> summarize_columns(const grid::BrickView& view,
                                                           int threads);

}  // namespace stormcellar::render
