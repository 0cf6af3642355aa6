// stormcellar/grid/brick_grid.h -- a quantised grid in bricks in memory; owns what a BrickView
// shows.
//
// Codes are dense-addressed (stormcellar/grid/brick_view.h), yet bricks without values take no
// memory in a large grid: 7000 x 3500 x 33 cells are 1.1 GiB of addresses and only the bricks
// written of pages. Cells beyond the grid's edge in the last bricks are no cells: they have code 0,
// and count neither way where a brick's cells are all alike. Threads: const is safe; different
// BricksWriters may write different bricks at the same time. Accuracy: a value is off by at most
// half a quantisation step; values beyond the code range are clamped to its ends and counted in
// clamped_count.
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
    // Every cell not seen.
    BrickGrid(GridSpec spec, const Quantization& quantization);

    // The same to the bit for any number of threads.
    [[nodiscard]] static BrickGrid from(const Grid& grid, const Quantization& quantization,
                                        int threads = 1);

    // Valid as long as this object lives and is not moved.
    [[nodiscard]] BrickView view() const;
    [[nodiscard]] std::uint64_t clamped_count() const { return clamped_count_; }
    [[nodiscard]] const GridSpec& spec() const { return spec_; }

    // Takes over what the writers hold beside the codes. Each has written bricks behind those of
    // the one before it, in rising order; so states stand in the order of their bricks.
    void finish(std::span<BricksWriter> writers);

    // Bricks become not seen, to be written anew: then finish_again(), whose writers may have
    // written in any order. States stand in the order of their bricks again, as if the grid had
    // been written at once, but for what clamped_count() counts: all that was ever clamped.
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

// How many of a brick's cells lie within the grid, along each axis.
struct BrickExtent {
    int x = brick_edge;
    int y = brick_edge;
    int z = brick_edge;
    [[nodiscard]] int cells() const { return x * y * z; }
};
[[nodiscard]] BrickExtent brick_extent(const GridSpec& spec, int bx, int by, int bz);

// Writes bricks of a new BrickGrid, each at most once and in rising order. What is not written is
// not seen. The grid must outlive the writer and not move; BrickGrid::finish() ends the writing.
class BricksWriter {
  public:
    explicit BricksWriter(BrickGrid& grid) : grid_(&grid) {}

    void put_uniform(std::size_t brick, CellStatus status);
    // 4,096 codes, 0 in all cells beyond the extent; the grid's codes must be as long as Code.
    template <class Code>
    void put_codes(std::size_t brick, const Code* codes, const BrickExtent& extent);
    // 1,024 bytes of states, none of them a value.
    void put_states(std::size_t brick, std::span<const std::byte> states,
                    const BrickExtent& extent);
    // A brick of a view with the same quantisation, its cells as they are.
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

// The opposite: every cell of a view as value and status.
[[nodiscard]] Grid to_dense(const BrickView& view);

}  // namespace stormcellar::grid
