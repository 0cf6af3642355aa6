// render/volume/slice_mask.h -- tells which slices may show anything, for each part of the picture.
//
// The picture is divided into square tiles. Each tile has a bit for each step (between two slices).
// The bit tells whether any pixel of the tile may find a visible value at any point of that step.
// Bits err only on the safe side: a set bit may be useless, but a cleared bit never hides anything.
// The least and the largest code of a brick tell whether the brick may be visible, and then the
// codes of its blocks tell which parts may be visible. Blocks are 2 to 16 cells wide, about as wide
// as 8 pixels.
//
// Threads   Immutable; many threads may call fill_band().
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "render/volume/transfer_function.h"
#include "stormcellar/grid/brick_view.h"
#include "stormcellar/render/view_geometry.h"

namespace stormcellar::render {

// Edges of tiles in pixels. A small tile is as large as one packet of rays, so that fewer steps are
// sampled in vain.
inline constexpr int tile_edge = 8, small_tile_edge = 4;

class SliceMask {
  public:
    // The geometry must outlive the mask.
    SliceMask(const grid::BrickView& view, const ViewGeometry& geometry, int slices,
              const TransferFunction& transfer, int threads, int edge = tile_edge);

    [[nodiscard]] int edge() const { return edge_; }  // edge of a tile in pixels
    [[nodiscard]] int tiles_across() const { return tiles_across_; }
    [[nodiscard]] int tiles_down() const { return tiles_down_; }
    [[nodiscard]] std::size_t words_per_tile() const { return words_per_tile_; }

    // Fills the bits of one row of tiles: tiles_across() times words_per_tile() words. Returns
    // false if no bit is set.
    bool fill_band(int tile_row, std::vector<std::uint64_t>& words) const;

  private:
    // The space that visible cells may color: the cells, and the space between them and their
    // neighbors.
    struct Box {
        Vec3 low, high;  // in drawn space, widened by half a tile at the box's farthest corner
        int first_tile, last_tile, first_row, last_row;
    };
    // The motion of the rays along each axis. `per_step` is 1 / step, for the axes along which the
    // rays move.
    struct Direction {
        Vec3 per_step;
        bool moves[3];
    };
    struct Cells;
    struct Outline;
    using Boxes = std::vector<Box>;
    void add_brick(const grid::BrickView& view, const TransferFunction& transfer,
                   const std::array<int, 3>& brick, Boxes& boxes) const;
    void add_cells(const grid::GridSpec& spec, const Cells& cells, Boxes& boxes) const;
    [[nodiscard]] Outline parallel_outline(const Box& box) const;
    [[nodiscard]] Outline perspective_outline(const Box& box) const;
    [[nodiscard]] bool place_in_picture(Box& box) const;
    [[nodiscard]] Direction direction(const Vec3& along) const;
    void mark(const Box& box, const Vec3& start, const Direction& direction,
              std::uint64_t* words) const;

    const ViewGeometry& geometry_;
    int slices_, edge_;
    double step_m_;
    int tiles_across_, tiles_down_;
    std::size_t words_per_tile_;
    int block_edge_;  // cells
    struct BoxNumber {
        std::uint32_t slab, box;
    };
    std::vector<Boxes> boxes_;           // for each slab of bricks
    std::vector<BoxNumber> in_rows_;     // the boxes that reach into each row of tiles
    std::vector<std::size_t> row_ends_;  // where each row ends in in_rows_
};

}  // namespace stormcellar::render
