// render/products/water_rows.h -- computes the share of water under each pixel of a row.
//
// Most places are far from any shore, so the mask is divided into blocks. If all blocks under a run
// of pixels are plain land or plain water, the pixels of the run need no work of their own.
//
// Accuracy  Equal to WaterMask::water_at() to the bit.
// Threads   Immutable; each thread has a WaterRow of its own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/products/water_mask.h"
#include "stormcellar/render/view_geometry.h"

namespace stormcellar::render {

struct WaterRow {
    std::vector<double> share;  // of each pixel, 0..1; has no meaning for the sky
    std::vector<double> x, y;   // where the pixels are in the raster
};

class WaterRows {
  public:
    // The mask must not be empty and must outlive this object.
    explicit WaterRows(const WaterMask& mask);

    void find(const GroundRow& row, WaterRow& found) const;

  private:
    static constexpr std::int16_t shore = -1;  // marks a block whose cells differ

    // Returns the share that all cells about the pixels from `first` to before `end` have in
    // common, or `shore` if they differ.
    [[nodiscard]] std::int16_t common(const WaterRow& row, std::size_t first,
                                      std::size_t end) const;
    [[nodiscard]] std::int16_t& block(int bx, int by) {
        return blocks_[static_cast<std::size_t>(by) * static_cast<std::size_t>(across_) +
                       static_cast<std::size_t>(bx)];
    }

    const WaterMask& mask_;
    int across_, down_;
    std::vector<std::int16_t> blocks_;
};

}  // namespace stormcellar::render
