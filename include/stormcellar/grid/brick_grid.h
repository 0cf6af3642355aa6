// stormcellar/grid/brick_grid.h -- a quantized grid in bricks in memory. It owns the bytes that a
// BrickView shows.
//
// Codes are dense-addressed (stormcellar/grid/brick_view.h), yet bricks without values take no
// memory in a large grid: 7000 x 3500 x 33 cells take 1.1 GiB of addresses, but pages only for the
// bricks that were written. The last bricks reach beyond the edge of the grid. Their places there
// are not cells: they have code 0, and they do not count when a brick is checked for cells that are
// all alike.
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

    // Takes over the states and counts of the writers. Each writer must have written bricks after
    // those of the writer before it, in rising order, so that the states are in the order of their
    // bricks.
    void finish(std::span<BricksWriter> writers);

    // clear() makes bricks not seen, so that they can be written anew. finish_again() then takes
    // over from their writers, which may have written in any order. Afterward the states are in the
    // order of their bricks again, as if the grid had been written at once. Only clamped_count()
    // differs, because it also counts the values of bricks that were cleared.
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
// written are not seen. The grid must outlive the writer and must not move. BrickGrid::finish()
// ends the writing.
class BricksWriter {
  public:
    explicit BricksWriter(BrickGrid& grid) : grid_(&grid) {}

    void put_uniform(std::size_t brick, CellStatus status);
    // Writes 4,096 codes, which must be 0 in all places beyond the extent. Code must be as long as
    // the codes of the grid.
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

// Turns bricks into a dense grid: the value and the status of every cell of the view.
[[nodiscard]] Grid to_dense(const BrickView& view);

}  // namespace stormcellar::grid
