// render/volume/slice_mask.h -- which slices of which part of the picture may show anything.
//
// The picture is divided into square tiles. A bit for each tile and step (between two slices) says
// whether any point of that step under any pixel of the tile may find a visible value. Bits err to
// the safe side only. What may be visible is told by the bricks' least and largest codes, and
// inside a brick by those of its blocks, 2 to 16 cells wide, about as wide as 8 pixels. Thread
// contract: immutable; fill_band() may run on many threads.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "render/volume/transfer_function.h"
#include "stormcellar/grid/brick_view.h"
#include "stormcellar/render/view_geometry.h"

namespace stormcellar::render {

// Pixels. Small tiles are those of one packet of rays: fewer steps are sampled in vain.
inline constexpr int tile_edge = 8, small_tile_edge = 4;

class SliceMask {
  public:
    // The geometry must outlive this.
    SliceMask(const grid::BrickView& view, const ViewGeometry& geometry, int slices,
              const TransferFunction& transfer, int threads, int edge = tile_edge);

    [[nodiscard]] int edge() const { return edge_; }  // of a tile, pixels
    [[nodiscard]] int tiles_across() const { return tiles_across_; }
    [[nodiscard]] int tiles_down() const { return tiles_down_; }
    [[nodiscard]] std::size_t words_per_tile() const { return words_per_tile_; }

    // The bits of one row of tiles: tiles_across() times words_per_tile() words. False when no bit
    // is set.
    bool fill_band(int tile_row, std::vector<std::uint64_t>& words) const;

  private:
    // What visible cells may colour: they and all between them and their neighbours.
    struct Box {
        Vec3 low, high;  // drawn space, widened by what a tile spans where the box is farthest
        int first_tile, last_tile, first_row, last_row;
    };
    // How far the rays go along each axis: reciprocals of a step, and whether they move at all.
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
    std::vector<Boxes> boxes_;           // of each slab of bricks
    std::vector<BoxNumber> in_rows_;     // of tiles, row after row: the boxes that reach into them
    std::vector<std::size_t> row_ends_;  // in them
};

}  // namespace stormcellar::render
