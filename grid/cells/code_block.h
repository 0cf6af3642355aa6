// grid/cells/code_block.h -- the unpacked codes of a rectangle of columns and sixteen levels.
//
// A block holds a 16-bit code for each cell: the code of a value or of a state, whatever the kind
// of the brick (uniform, states, codes of one or two bytes). Places beyond the grid have the code
// of "not seen". Only code inside grid/ uses a CodeBlock, to read the neighbors of cells.
//
// Threads   One thread for each object.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "stormcellar/grid/brick_view.h"

namespace stormcellar::grid {

// The columns [x0, x1] x [y0, y1], both ends included. They may be beyond the grid.
struct ColumnBox {
    int x0 = 0, y0 = 0, x1 = -1, y1 = -1;
};

class CodeBlock {
  public:
    // Returns the state that all cells of the box have at brick height `bz`, if all bricks there
    // are uniform with this state; else none. Columns beyond the grid count as not seen.
    [[nodiscard]] static std::optional<CellStatus> uniform_status(const BrickView& view,
                                                                  const ColumnBox& box, int bz);
    void read(const BrickView& view, const ColumnBox& box, int bz);

    // Returns the sixteen codes of a column of the box, from the bottom up.
    [[nodiscard]] const std::uint16_t* column(int ix, int iy) const {
        return codes_.data() + (static_cast<std::size_t>(ix - box_.x0) * height_ +
                                static_cast<std::size_t>(iy - box_.y0)) *
                                   brick_edge;
    }

  private:
    void copy(const BrickView& view, std::size_t brick, const ColumnBox& part, int bx, int by);

    ColumnBox box_;
    std::size_t height_ = 0;
    std::vector<std::uint16_t> codes_;
};

}  // namespace stormcellar::grid
