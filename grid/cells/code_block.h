// grid/cells/code_block.h -- the codes of a rectangle of columns and sixteen levels, unpacked.
//
// Whatever a brick is (uniform, states, codes of one byte or two), here are its codes, 16 bits
// each, states included; beyond the grid all is not seen. For steps that read about a cell. Inside
// the grid room only. Threads: one for each object.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "stormcellar/grid/brick_view.h"

namespace stormcellar::grid {

// Columns [x0, x1] x [y0, y1], both ends included; they may lie beyond the grid.
struct ColumnBox {
    int x0 = 0, y0 = 0, x1 = -1, y1 = -1;
};

class CodeBlock {
  public:
    // The state of all of them, where they are all the same and of no value.
    [[nodiscard]] static std::optional<CellStatus> uniform_status(const BrickView& view,
                                                                  const ColumnBox& box, int bz);
    void read(const BrickView& view, const ColumnBox& box, int bz);

    // The sixteen codes of a column of the box, upward.
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
