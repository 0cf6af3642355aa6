// grid/brick_grid.h -- a dense Grid turned into bricks in memory; owns what a BrickView shows.
//
// Accuracy: a value is off by at most half a quantisation step; values beyond the code range are
// clamped to its ends and counted in clamped_count.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "grid/brick_view.h"
#include "grid/grid.h"

namespace stormcellar::grid {

class BrickGrid {
  public:
    // The cells beyond the grid's edge in the last bricks are "not seen".
    [[nodiscard]] static BrickGrid from(const Grid& grid, const Quantization& quantization);

    // Valid as long as this object lives and is not moved.
    [[nodiscard]] BrickView view() const;
    [[nodiscard]] std::uint64_t clamped_count() const { return clamped_count_; }
    [[nodiscard]] const GridSpec& spec() const { return spec_; }

  private:
    BrickGrid() = default;

    GridSpec spec_;
    Quantization quantization_;
    std::vector<std::byte> codes_;
    std::vector<BrickEntry> bricks_;
    std::vector<std::byte> states_;
    std::uint64_t clamped_count_ = 0;
};

// The opposite: every cell of a view as value and status.
[[nodiscard]] Grid to_dense(const BrickView& view);

}  // namespace stormcellar::grid
