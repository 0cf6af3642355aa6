#include "render/products/column_summary.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "base/parallel.h"

namespace stormcellar::render {
namespace {

using grid::brick_edge;
using grid::BrickEntry;
using grid::BrickKind;
using grid::BrickView;
using grid::CellStatus;

void note_status(ColumnSummary& column, CellStatus status, int level) {
    if (status == CellStatus::not_seen) return;
    column.lowest_seen = std::min(column.lowest_seen, static_cast<std::uint16_t>(level));
    column.has_no_echo = column.has_no_echo || status == CellStatus::no_echo;
    column.has_range_folded = column.has_range_folded || status == CellStatus::range_folded;
}

// Summarizes a whole run of 16 cells; cells beyond the top of the grid are stored as not seen.
// There are no branches, so that the compiler handles all cells at once.
template <class Code>
void note_codes(ColumnSummary& column, const std::byte* codes, int first_level) {
    std::array<Code, brick_edge> run{};
    std::memcpy(run.data(), codes, sizeof(run));
    Code largest = 0;
    Code no_echo = 0;
    Code folded = 0;
    for (const Code code : run) {
        largest = std::max(largest, code);
        no_echo = static_cast<Code>(no_echo | (code == 1 ? 1 : 0));
        folded = static_cast<Code>(folded | (code == 2 ? 1 : 0));
    }
    if (largest == 0) return;
    if (column.lowest_seen == ColumnSummary::never) {
        const auto seen = std::find_if(run.begin(), run.end(), [](Code c) { return c != 0; });
        column.lowest_seen = static_cast<std::uint16_t>(first_level + (seen - run.begin()));
    }
    column.has_no_echo = column.has_no_echo || no_echo != 0;
    column.has_range_folded = column.has_range_folded || folded != 0;
    if (largest >= grid::first_value_code) {
        column.max_code = std::max(column.max_code, std::uint16_t{largest});
    }
}

// Summarizes a whole run of 16 states of two bits, the lowest cell in the lowest bits.
void note_states(ColumnSummary& column, std::uint32_t states, int first_level) {
    constexpr std::uint32_t low_bits = 0x55555555;
    const std::uint32_t low = states & low_bits;
    const std::uint32_t high = (states >> 1) & low_bits;
    const std::uint32_t seen = low | high;
    if (seen == 0) return;
    const int lowest = first_level + std::countr_zero(seen) / 2;
    column.lowest_seen = std::min(column.lowest_seen, static_cast<std::uint16_t>(lowest));
    column.has_no_echo = column.has_no_echo || (low & ~high) != 0;
    column.has_range_folded = column.has_range_folded || (high & ~low) != 0;
}

// The part of one column that lies in one brick.
struct Run {
    std::size_t cell;  // index of the first cell of the run in the brick
    int cells;
    int first_level;
};

void note_run(ColumnSummary& column, const BrickView& view, std::size_t brick, const Run& run) {
    const BrickEntry& entry = view.bricks[brick];
    if (entry.kind == BrickKind::uniform) {
        note_status(column, entry.uniform_status, run.first_level);
    } else if (entry.kind == BrickKind::status_only) {
        const std::uint32_t states = states_of_run(view, entry, run.cell);
        // States beyond the top of the grid do not count.
        const int beyond = 2 * (brick_edge - run.cells);
        note_states(column, (states << beyond) >> beyond, run.first_level);
    } else {
        const auto width = static_cast<std::size_t>(view.quantization.code_bytes);
        const std::byte* codes = view.codes.data() + (brick * grid::brick_cells + run.cell) * width;
        if (width == 1) {
            note_codes<std::uint8_t>(column, codes, run.first_level);
        } else {
            note_codes<std::uint16_t>(column, codes, run.first_level);
        }
    }
}

// The columns of the grid that stand on one brick.
struct Stack {
    int bx = 0, by = 0;
    int first_x = 0, end_x = 0, first_y = 0, end_y = 0;
};

Stack stack_at(const grid::GridSpec& spec, int bx, int by) {
    return {bx,
            by,
            bx * brick_edge,
            std::min(spec.nx, (bx + 1) * brick_edge),
            by * brick_edge,
            std::min(spec.ny, (by + 1) * brick_edge)};
}

// Calls note(column, brick, run) for each run of the columns, brick by brick.
template <class Note>
void for_each_run(const BrickView& view, const Stack& stack, std::vector<ColumnSummary>& columns,
                  const Note& note) {
    const grid::GridSpec& spec = *view.spec;
    for (int bz = 0; bz < view.bricks_z; ++bz) {
        const std::size_t brick = view.brick_index(stack.bx, stack.by, bz);
        const int first = bz * brick_edge;
        const int cells = std::min(brick_edge, spec.nz() - first);
        for (int ix = stack.first_x; ix < stack.end_x; ++ix) {
            for (int iy = stack.first_y; iy < stack.end_y; ++iy) {
                const auto cell =
                    static_cast<std::size_t>((ix % brick_edge) * brick_edge + iy % brick_edge) *
                    brick_edge;
                note(columns[static_cast<std::size_t>(iy) * static_cast<std::size_t>(spec.nx) +
                             static_cast<std::size_t>(ix)],
                     brick, Run{cell, cells, first});
            }
        }
    }
}

// All columns of a stack of uniform bricks are the same.
void summarize_uniform(const BrickView& view, const Stack& stack,
                       std::vector<ColumnSummary>& columns) {
    ColumnSummary same;
    for (int bz = 0; bz < view.bricks_z; ++bz) {
        note_status(same, view.bricks[view.brick_index(stack.bx, stack.by, bz)].uniform_status,
                    bz * brick_edge);
    }
    for (int iy = stack.first_y; iy < stack.end_y; ++iy) {
        const auto row =
            columns.begin() + static_cast<std::ptrdiff_t>(iy) * std::ptrdiff_t{view.spec->nx};
        std::fill(row + stack.first_x, row + stack.end_x, same);
    }
}

// Summarizes the rows of columns that lie in the bricks with this y number.
void summarize_band(const BrickView& view, int by, std::vector<ColumnSummary>& columns) {
    for (int bx = 0; bx < view.bricks_x; ++bx) {
        const Stack stack = stack_at(*view.spec, bx, by);
        if (is_uniform_stack(view, bx, by)) {
            summarize_uniform(view, stack, columns);
            continue;
        }
        for_each_run(view, stack, columns,
                     [&view](ColumnSummary& column, std::size_t brick, const Run& run) {
                         note_run(column, view, brick, run);
                     });
    }
}

}  // namespace

std::uint32_t states_of_run(const BrickView& view, const BrickEntry& entry, std::size_t cell) {
    const std::byte* bytes =
        view.states.data() + std::size_t{entry.status_index} * (grid::brick_cells / 4) + cell / 4;
    std::uint32_t states = 0;
    for (unsigned i = 0; i < 4; ++i)
        states |= std::to_integer<std::uint32_t>(bytes[i]) << (8 * i);
    return states;
}

bool is_uniform_stack(const BrickView& view, int bx, int by) {
    for (int bz = 0; bz < view.bricks_z; ++bz)
        if (view.bricks[view.brick_index(bx, by, bz)].kind != BrickKind::uniform) return false;
    return true;
}

CellStatus ColumnSummary::status() const {
    if (max_code > 0) return CellStatus::value;
    if (has_range_folded) return CellStatus::range_folded;
    return has_no_echo ? CellStatus::no_echo : CellStatus::not_seen;
}

std::vector<ColumnSummary> summarize_columns(const BrickView& view, int threads) {
    std::vector<ColumnSummary> columns(view.spec->column_count());
    for_each_piece(view.bricks_y, threads, [&](int by) { summarize_band(view, by, columns); });
    return columns;
}

}  // namespace stormcellar::render
