#include "render/products/column_summary.h"

#include <algorithm>
#include <array>
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
        for (int z = 0; z < run.cells; ++z) {
            const std::size_t cell = run.cell + static_cast<std::size_t>(z);
            const auto four = std::to_integer<unsigned>(
                view.states[std::size_t{entry.status_index} * (grid::brick_cells / 4) + cell / 4]);
            note_status(column, static_cast<CellStatus>((four >> (2 * (cell % 4))) & 3U),
                        run.first_level + z);
        }
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

// Summarizes the rows of columns that lie in the bricks with this y number.
void summarize_band(const BrickView& view, int by, std::vector<ColumnSummary>& columns) {
    const grid::GridSpec& spec = *view.spec;
    const int last_y = std::min(spec.ny, (by + 1) * brick_edge);
    for (int iy = by * brick_edge; iy < last_y; ++iy) {
        for (int ix = 0; ix < spec.nx; ++ix) {
            ColumnSummary& column =
                columns[static_cast<std::size_t>(iy) * static_cast<std::size_t>(spec.nx) +
                        static_cast<std::size_t>(ix)];
            const auto cell =
                static_cast<std::size_t>((ix % brick_edge) * brick_edge + iy % brick_edge) *
                brick_edge;
            for (int bz = 0; bz < view.bricks_z; ++bz) {
                const int first = bz * brick_edge;
                note_run(column, view, view.brick_index(ix / brick_edge, by, bz),
                         {cell, std::min(brick_edge, spec.nz() - first), first});
            }
        }
    }
}

}  // namespace

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
