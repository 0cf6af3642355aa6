// stormcellar/grid/brick_grid.h -- a quantized grid in bricks in memory. A BrickGrid owns the bytes
// that a BrickView shows.
//
// Every brick has a fixed address (stormcellar/grid/brick_view.h), yet in a large grid a brick
// without values takes no memory: 7000 x 3500 x 33 cells reserve 1.1 GiB of addresses, but use
// memory pages only for bricks that were written. The last bricks reach beyond the edge of the
// grid. Places beyond the edge are not cells. Their code is 0, and they do not affect whether a
// brick is uniform.
//
// Threads   Any thread may call const functions. Different BricksWriters may write different bricks
//           at the same time.
// Errors    None; the caller must keep to the contracts stated below.
// Accuracy  A value is off by at most half a quantization step. Values beyond the range of codes
//           are clamped to its ends and counted in clamped_count().
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "stormcellar/base/sparse_bytes.h"
#include "stormcellar/grid/brick_view.h"
#include "stormcellar/grid/grid.h"

namespace stormcellar::grid {

class BricksWriter;

class BrickGrid {
  public:
    // Makes a grid in which no cell is seen.
    BrickGrid(GridSpec spec, const Quantization& quantization);

    // Quantizes a grid. The result has the same bits for any number of threads.
    [[nodiscard]] static BrickGrid from(const Grid& grid, const Quantization& quantization,
                                        int threads = 1);

    // Returns a view, which is valid as long as this object lives and is not moved.
    [[nodiscard]] BrickView view() const;
    [[nodiscard]] std::uint64_t clamped_count() const { return clamped_count_; }
    [[nodiscard]] const GridSpec& spec() const { return spec_; }

    // Takes over the states and counts of the writers. Each writer must have written its bricks in
    // rising order, after all bricks of the writer before it, so that the states are in the order
    // of their bricks.
    void finish(std::span<BricksWriter> writers);

    // To write bricks anew, call clear() for each brick, which makes its cells not seen, and write
    // the bricks in any order. Then call finish_again() with the writers. Afterward the states are
    // in the order of their bricks, as if the grid had been written at once. Only clamped_count()
    // differs, because it still includes the values of cleared bricks.
    void clear(std::size_t brick);
    void finish_again(std::span<BricksWriter> writers);

  private:
    friend class BricksWriter;

    GridSpec spec_;
    Quantization quantization_;
    SparseBytes codes_;
    std::vector<BrickEntry> bricks_;
    std::vector<std::byte> states_;
    std::uint64_t clamped_count_ = 0;
};

// Numbers of cells of a brick that are within the grid, along each axis.
struct BrickExtent {
    int x = brick_edge;
    int y = brick_edge;
    int z = brick_edge;
    [[nodiscard]] int cells() const { return x * y * z; }
};
[[nodiscard]] BrickExtent brick_extent(const GridSpec& spec, int bx, int by, int bz);

// Writes the bricks of a new BrickGrid, each at most once and in rising order. Bricks that are not
// written stay not seen. The grid must outlive the writer and must not move. At the end, pass the
// writer to BrickGrid::finish().
class BricksWriter {
  public:
    explicit BricksWriter(BrickGrid& grid) : grid_(&grid) {}

    void put_uniform(std::size_t brick, CellStatus status);
    // Writes 4,096 codes, which must be 0 in all places beyond the extent. The size of Code must
    // equal the quantization's code_bytes.
    template <class Code>
    void put_codes(std::size_t brick, const Code* codes, const BrickExtent& extent);
    // Writes 1,024 bytes of states, none of which may be a value.
    void put_states(std::size_t brick, std::span<const std::byte> states,
                    const BrickExtent& extent);
    // Copies a brick, cell by cell, from a view with the same quantization.
    void copy(std::size_t brick, const BrickView& from, std::size_t from_brick);

    void count_clamped(std::uint64_t cells) { clamped_count_ += cells; }

  private:
    friend class BrickGrid;

    void add_states(std::size_t brick, std::span<const std::byte> states, std::uint64_t checksum);

    BrickGrid* grid_;
    std::vector<std::byte> states_;
    std::vector<std::size_t> bricks_with_states_;
    std::uint64_t clamped_count_ = 0;
};

// Copies a grid in bricks into a dense grid: the value and the status of every cell.
[[nodiscard]] Grid to_dense(const BrickView& view);

}  // namespace stormcellar::grid
