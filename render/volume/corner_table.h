// render/volume/corner_table.h -- puts the codes of four neighboring columns into one word for each
// cell.
//
// A sample needs the eight codes around it. In a grid file, these codes are in up to eight bricks.
// In this table, they are in two consecutive words, which one load of 64 bits reads. Word (x, y, z)
// holds the codes of the cells (x, y), (x + 1, y), (x, y + 1) and (x + 1, y + 1) of level z, the
// first of them in its low byte. The last cell along an axis is repeated beyond the edge of the
// grid. Cells of bricks without any value are 0, whatever their state.
//
// The table takes four bytes for each cell of bricks with values, and time to fill. It saves time
// if there are many samples for each cell; serves() decides this.
//
// Threads   fill() may be called by one thread at a time; then many threads may read.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <vector>

#include "stormcellar/grid/brick_view.h"

namespace stormcellar::render {

class CornerTable {
  public:
    // Returns true for grids of up to 2^24 cells with codes of one byte, if rays without any
    // skipping would sample each cell 12 times or more. With fewer samples, a frame is faster
    // without the table.
    [[nodiscard]] static bool serves(const grid::BrickView& view, double samples);

    // Takes the codes of a grid for which serves() is true. Takes less time if the last grid had
    // the same size.
    void fill(const grid::BrickView& view, int threads);

    [[nodiscard]] const std::byte* words() const {
        return reinterpret_cast<const std::byte*>(words_.get());
    }
    // Return the distance, in words, to the next cell along x or y. The next cell along z is the
    // next word.
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
    std::vector<char> written_;  // bricks that may hold words other than 0
};

}  // namespace stormcellar::render
