// render/products/column_summary.h -- summarizes each column of a grid in three numbers.
//
// 2D products and the ground of the 3D view need the lowest level at which the column was seen, its
// highest value, and the states that it holds.
//
// Threads   Plain values and a pure function.
#pragma once

#include <cstdint>
#include <vector>

#include "stormcellar/grid/brick_view.h"

namespace stormcellar::render {

struct ColumnSummary {
    static constexpr std::uint16_t never = 0xFFFF;
    std::uint16_t lowest_seen = never;  // the level of the lowest cell that is not "not seen"
    std::uint16_t max_code = 0;         // over the cells with a value; 0: none
    bool has_no_echo = false;
    bool has_range_folded = false;
    bool has_ambiguous = false;

    // Returns the state of the column maximum. It is the first of value, ambiguous, range folded
    // (where echo is unknown) and no echo that some cell has, or not seen if no cell has any of
    // these states.
    [[nodiscard]] grid::CellStatus status() const {
        if (max_code > 0) return grid::CellStatus::value;
        if (has_ambiguous) return grid::CellStatus::ambiguous;
        if (has_range_folded) return grid::CellStatus::range_folded;
        return has_no_echo ? grid::CellStatus::no_echo : grid::CellStatus::not_seen;
    }
};

// Returns true if all bricks of this column of bricks are uniform. All columns of cells in these
// bricks are then equal and have no value.
[[nodiscard]] bool is_uniform_stack(const grid::BrickView& view, int bx, int by);

// Returns the states of 16 cells of a column in a brick of states, from this cell upward: two bits
// for each cell, the lowest cell in the lowest bits.
[[nodiscard]] std::uint32_t states_of_run(const grid::BrickView& view,
                                          const grid::BrickEntry& entry, std::size_t cell);

// Summarizes all columns: rows from south to north, each from west to east. The result is the same
// for any number of threads.
[[nodiscard]] std::vector<ColumnSummary> summarize_columns(const grid::BrickView& view,
                                                           int threads);

}  // namespace stormcellar::render
