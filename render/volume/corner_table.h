// render/volume/corner_table.h -- the codes of four columns beside each other in one word a cell.
//
// A sample needs the eight codes round it. In a grid file they lie in up to eight bricks; here in
// two words behind each other, which one load of 64 bits brings: word (x, y, z) holds the codes of
// the cells (x, y), (x + 1, y), (x, y + 1) and (x + 1, y + 1) of level z, the first in its low
// byte. Beyond the grid's last cell along an axis stands that cell again. Cells of bricks without
// any value are 0, whatever their state.
// It takes four bytes a cell, of bricks with values, and time to fill: worth it where samples are
// many for the cells, which serves() tells.
// Thread contract: fill() is one writer; what it wrote may be read by many threads.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <vector>

#include "stormcellar/grid/brick_view.h"

namespace stormcellar::render {

class CornerTable {
  public:
    // For grids of up to 2^24 cells with codes of one byte, each sampled 12 times or more if
    // nothing were skipped (docs/decisions/slicer.md).
    [[nodiscard]] static bool serves(const grid::BrickView& view, double samples);

    // Takes over the codes of a grid that it serves; quicker for one of the same size as before.
    void fill(const grid::BrickView& view, int threads);

    [[nodiscard]] const std::byte* words() const {
        return reinterpret_cast<const std::byte*>(words_.get());
    }
    // Words from cell to cell; along z 1.
    [[nodiscard]] std::int32_t stride_x() const { return stride_x_; }
    [[nodiscard]] std::int32_t stride_y() const { return stride_y_; }

  private:
    struct Free {
        void operator()(std::uint32_t* words) const { std::free(words); }
    };
    struct Columns;
    void make_room(const grid::BrickView& view);
    void fill_bricks(const grid::BrickView& view, int bx, int by);
    void fill_brick(const grid::BrickView& view, const Columns& columns, int bz);
    [[nodiscard]] std::uint32_t* at(int x, int y, int z) {
        return words_.get() + static_cast<std::ptrdiff_t>(x) * stride_x_ +
               static_cast<std::ptrdiff_t>(y) * stride_y_ + z;
    }

    std::unique_ptr<std::uint32_t, Free> words_;
    std::size_t word_count_ = 0;
    std::int32_t stride_x_ = 0, stride_y_ = 0;
    std::vector<char> written_;  // bricks that may hold other words than 0
};

}  // namespace stormcellar::render
