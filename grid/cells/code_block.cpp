#include "grid/cells/code_block.h"

#include <algorithm>
#include <cstring>

namespace stormcellar::grid {
namespace {

// Returns the part of a box that is in the grid. If no part is, returns a box with x1 < x0 or y1 <
// y0.
ColumnBox inside(const BrickView& view, const ColumnBox& box) {
    return {std::max(box.x0, 0), std::max(box.y0, 0), std::min(box.x1, view.spec->nx - 1),
            std::min(box.y1, view.spec->ny - 1)};
}

bool is_empty(const ColumnBox& box) {
    return box.x1 < box.x0 || box.y1 < box.y0;
}

bool is_same(const ColumnBox& a, const ColumnBox& b) {
    return a.x0 == b.x0 && a.y0 == b.y0 && a.x1 == b.x1 && a.y1 == b.y1;
}

}  // namespace

std::optional<CellStatus> CodeBlock::uniform_status(const BrickView& view, const ColumnBox& box,
                                                    int bz) {
    const ColumnBox part = inside(view, box);
    if (is_empty(part)) return CellStatus::not_seen;
    std::optional<CellStatus> status;
    if (!is_same(part, box)) status = CellStatus::not_seen;
    for (int bx = part.x0 / brick_edge; bx <= part.x1 / brick_edge; ++bx) {
        for (int by = part.y0 / brick_edge; by <= part.y1 / brick_edge; ++by) {
            const BrickEntry& entry = view.bricks[view.brick_index(bx, by, bz)];
            if (entry.kind != BrickKind::uniform) return std::nullopt;
            if (status.value_or(entry.uniform_status) != entry.uniform_status) return std::nullopt;
            status = entry.uniform_status;
        }
    }
    return status;
}

void CodeBlock::read(const BrickView& view, const ColumnBox& box, int bz) {
    box_ = box;
    const int width = box.x1 - box.x0 + 1;
    const int height = box.y1 - box.y0 + 1;
    height_ = static_cast<std::size_t>(height);
    codes_.assign(static_cast<std::size_t>(width) * height_ * brick_edge, 0);
    const ColumnBox part = inside(view, box);
    if (is_empty(part)) return;
    for (int bx = part.x0 / brick_edge; bx <= part.x1 / brick_edge; ++bx) {
        for (int by = part.y0 / brick_edge; by <= part.y1 / brick_edge; ++by) {
            const ColumnBox here{std::max(part.x0, bx * brick_edge),
                                 std::max(part.y0, by * brick_edge),
                                 std::min(part.x1, (bx + 1) * brick_edge - 1),
                                 std::min(part.y1, (by + 1) * brick_edge - 1)};
            copy(view, view.brick_index(bx, by, bz), here, bx, by);
        }
    }
}

void CodeBlock::copy(const BrickView& view, std::size_t brick, const ColumnBox& part, int bx,
                     int by) {
    const BrickEntry& entry = view.bricks[brick];
    const auto uniform = static_cast<std::uint16_t>(entry.uniform_status);
    const std::size_t states = entry.status_index * state_block_bytes;
    for (int ix = part.x0; ix <= part.x1; ++ix) {
        for (int iy = part.y0; iy <= part.y1; ++iy) {
            const int column_here = (ix - bx * brick_edge) * brick_edge + iy - by * brick_edge;
            const std::size_t cell = static_cast<std::size_t>(column_here) * brick_edge;
            std::uint16_t* const to = codes_.data() + (column(ix, iy) - codes_.data());
            const std::size_t from = brick * brick_cells + cell;
            if (entry.kind == BrickKind::uniform) {
                std::fill_n(to, brick_edge, uniform);
            } else if (entry.kind == BrickKind::status_only) {
                for (std::size_t z = 0; z < brick_edge; ++z) {
                    const auto four = static_cast<unsigned>(view.states[states + (cell + z) / 4]);
                    to[z] = static_cast<std::uint16_t>((four >> (2 * ((cell + z) % 4))) & 3U);
                }
            } else if (view.quantization.code_bytes == 1) {
                for (std::size_t z = 0; z < brick_edge; ++z)
                    to[z] = static_cast<std::uint16_t>(view.codes[from + z]);
            } else {
                std::memcpy(to, view.codes.data() + 2 * from, 2 * brick_edge);
            }
        }
    }
}

}  // namespace stormcellar::grid
