// render/volume/slice_mask.h -- which slices of which part of the picture may show anything.
//
// The picture is divided into square tiles. A bit for each tile and step (between two slices) says
// whether any point of that step under any pixel of the tile may find a visible value. Bits err to
// the safe side only.
// Thread contract: SliceMask is immutable; fill_band() may run on many threads.
#pragma once

#include <cstdint>
#include <vector>

#include "grid/brick_view.h"
#include "render/view_geometry.h"
#include "render/volume/transfer_function.h"

namespace stormcellar::render {

inline constexpr int tile_edge = 8;  // pixels

class SliceMask {
  public:
    // The geometry must outlive this.
    SliceMask(const grid::BrickView& view, const ViewGeometry& geometry, int slices,
              const TransferFunction& transfer);

    [[nodiscard]] int tiles_across() const { return tiles_across_; }
    [[nodiscard]] int tiles_down() const { return tiles_down_; }
    [[nodiscard]] std::size_t words_per_tile() const { return words_per_tile_; }

    // The bits of one row of tiles: tiles_across() times words_per_tile() words. False when no bit
    // is set.
    bool fill_band(int tile_row, std::vector<std::uint64_t>& words) const;

  private:
    // What a visible brick may colour: its cells and all between them and their neighbours.
    struct Box {
        Vec3 low, high;                   // drawn space
        double left, right, top, bottom;  // pixels
        double tile_half_m;               // half a tile's width where it is farthest
    };
    void add_brick(const grid::GridSpec& spec, int bx, int by, int bz);
    void place_in_picture(Box& box) const;
    void mark(const Box& box, int tile_row, int tile, std::uint64_t* words) const;

    const ViewGeometry& geometry_;
    int slices_;
    double step_m_;
    int tiles_across_, tiles_down_;
    std::size_t words_per_tile_;
    std::vector<Box> boxes_;
};

}  // namespace stormcellar::render
