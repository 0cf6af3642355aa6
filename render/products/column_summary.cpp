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
static_assert(std::endian::native == std::endian::little);

// Notes the lowest level that was seen in a run of up to 16 cells of a column, and the states in
// the run.
void note_states(ColumnSummary& column, int lowest_seen, bool has_no_echo, bool has_range_folded) {
    column.lowest_seen = std::min(column.lowest_seen, static_cast<std::uint16_t>(lowest_seen));
    column.has_no_echo = column.has_no_echo || has_no_echo;
    column.has_range_folded = column.has_range_folded || has_range_folded;
}

// Summarizes a whole run of 16 cells; cells beyond the top of the grid are stored as not seen. The
// loop has no branches, so that the compiler can compute all cells at once.
template <class Code>
void note_codes(ColumnSummary& column, const std::byte* codes, int first_level, Code first_code) {
    std::array<Code, brick_edge> run{};
    std::memcpy(run.data(), codes, sizeof(run));
    Code largest = 0;
    Code no_echo = 0;
    Code folded = 0;
    Code ambiguous = 0;
    for (const Code code : run) {
        largest = std::max(largest, code);
        no_echo = static_cast<Code>(no_echo | (code == 1 ? 1 : 0));
        folded = static_cast<Code>(folded | (code == 2 ? 1 : 0));
        ambiguous = static_cast<Code>(ambiguous | (code == first_code - 1 ? 1 : 0));
    }
    if (largest == 0) return;
    if (column.lowest_seen == ColumnSummary::never) {
        const auto seen = std::find_if(run.begin(), run.end(), [](Code c) { return c != 0; });
        column.lowest_seen = static_cast<std::uint16_t>(first_level + (seen - run.begin()));
    }
    column.has_no_echo = column.has_no_echo || no_echo != 0;
    column.has_range_folded = column.has_range_folded || folded != 0;
    if (first_code > grid::first_value_code)
        column.has_ambiguous = column.has_ambiguous || ambiguous != 0;
    if (largest >= first_code) {
        column.max_code = std::max(column.max_code, std::uint16_t{largest});
    }
}

// Summarizes a run of 16 equal bytes that mean clear air or air that was not seen. Most runs are
// like this. Returns false for any other run.
bool note_plain_bytes(ColumnSummary& column, const std::byte* codes, int first_level) {
    std::array<std::uint64_t, 2> run{};
    static_assert(sizeof(run) == brick_edge);
    std::memcpy(run.data(), codes, sizeof(run));
    if (run[0] != run[1]) return false;
    constexpr std::uint64_t all_no_echo = 0x0101010101010101;
    if (run[0] == all_no_echo) note_states(column, first_level, true, false);
    return run[0] == all_no_echo || run[0] == 0;
}

// Summarizes a run of up to 16 states of two bits each. The lowest cell has the lowest bits.
void note_packed_states(ColumnSummary& column, std::uint32_t states, int cells, int first_level) {
    if (cells < brick_edge) states &= (std::uint32_t{1} << (2 * cells)) - 1;
    if (states == 0) return;
    constexpr std::uint32_t low_bits = 0x55555555;
    const std::uint32_t low = states & low_bits;
    const std::uint32_t high = (states >> 1) & low_bits;
    static_assert(static_cast<int>(CellStatus::no_echo) == 1);
    static_assert(static_cast<int>(CellStatus::range_folded) == 2);
    note_states(column, first_level + std::countr_zero(states) / 2, (low & ~high) != 0,
                (high & ~low) != 0);
}

// Calls note(column, index of its first cell in the brick) for the columns of a brick.
template <class Note>
void for_each_column(const BrickView& view, int bx, int by, std::vector<ColumnSummary>& columns,
                     const Note& note) {
    const grid::GridSpec& spec = *view.spec;
    const int last_x = std::min(spec.nx, (bx + 1) * brick_edge);
    const int last_y = std::min(spec.ny, (by + 1) * brick_edge);
    for (int iy = by * brick_edge; iy < last_y; ++iy) {
        ColumnSummary* const row =
            columns.data() + static_cast<std::size_t>(iy) * static_cast<std::size_t>(spec.nx);
        for (int ix = bx * brick_edge; ix < last_x; ++ix) {
            note(row[ix],
                 static_cast<std::size_t>((ix % brick_edge) * brick_edge + iy % brick_edge) *
                     brick_edge);
        }
    }
}

void summarize_brick(const BrickView& view, int bx, int by, int bz,
                     std::vector<ColumnSummary>& columns) {
    const std::size_t brick = view.brick_index(bx, by, bz);
    const BrickEntry& entry = view.bricks[brick];
    const int first = bz * brick_edge;
    if (entry.kind == BrickKind::uniform) {
        const CellStatus status = entry.uniform_status;
        if (status == CellStatus::not_seen) return;
        for_each_column(view, bx, by, columns, [&](ColumnSummary& column, std::size_t /*cell*/) {
            note_states(column, first, status == CellStatus::no_echo,
                        status == CellStatus::range_folded);
        });
        return;
    }
    if (entry.kind == BrickKind::status_only) {
        const int cells = std::min(brick_edge, view.spec->nz() - first);
        for_each_column(view, bx, by, columns, [&](ColumnSummary& column, std::size_t cell) {
            note_packed_states(column, states_of_run(view, entry, cell), cells, first);
        });
        return;
    }
    const std::byte* const codes =
        view.codes.data() +
        brick * grid::brick_cells * static_cast<std::size_t>(view.quantization.code_bytes);
    const bool in_bytes = view.quantization.code_bytes == 1;
    const std::uint16_t first_code = view.quantization.first_code();
    for_each_column(view, bx, by, columns, [&](ColumnSummary& column, std::size_t cell) {
        if (!in_bytes)
            return note_codes<std::uint16_t>(column, codes + 2 * cell, first, first_code);
        if (!note_plain_bytes(column, codes + cell, first))
            note_codes(column, codes + cell, first, static_cast<std::uint8_t>(first_code));
    });
}

// Summarizes the columns in the bricks with this y number, from the lowest brick to the highest.
void summarize_band(const BrickView& view, int by, std::vector<ColumnSummary>& columns) {
    for (int bx = 0; bx < view.bricks_x; ++bx) {
        for (int bz = 0; bz < view.bricks_z; ++bz)
            summarize_brick(view, bx, by, bz, columns);
    }
}

}  // namespace

std::uint32_t states_of_run(const BrickView& view, const BrickEntry& entry, std::size_t cell) {
    std::uint32_t states = 0;
    std::memcpy(
        &states,
        view.states.data() + std::size_t{entry.status_index} * (grid::brick_cells / 4) + cell / 4,
        sizeof states);
    return states;
}

bool is_uniform_stack(const BrickView& view, int bx, int by) {
    for (int bz = 0; bz < view.bricks_z; ++bz)
        if (view.bricks[view.brick_index(bx, by, bz)].kind != BrickKind::uniform) return false;
    return true;
}

std::vector<ColumnSummary> summarize_columns(const BrickView& view, int threads) {
    std::vector<ColumnSummary> columns(view.spec->column_count());
    for_each_piece(view.bricks_y, threads, [&](int by) { summarize_band(view, by, columns); });
    return columns;
}

}  // namespace stormcellar::render
