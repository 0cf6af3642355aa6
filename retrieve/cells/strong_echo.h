// retrieve/cells/strong_echo.h -- the grid cells of a view with strong reflectivity, the strongest
// first, and a lookup by place.
//
// Only bricks whose largest code is strong are read, so that the time grows with the strong echo,
// not with the grid.
//
// Units     dBZ. Reflectivity is sorted in steps of `level_step_db`.
// Threads   A StrongEcho is immutable after its construction.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "stormcellar/grid/brick_view.h"

namespace stormcellar::retrieve {

inline constexpr float level_step_db = 0.5F;

struct StrongGridCell {
    std::int16_t ix = 0, iy = 0, iz = 0;
    std::uint8_t level = 0;  // steps above the least reflectivity, plus 1
};

class StrongEcho {
  public:
    // Collects the cells of at least `least_dbz`. Cells of the same level are in the order of the
    // bricks.
    StrongEcho(const grid::BrickView& view, float least_dbz);

    [[nodiscard]] std::span<const StrongGridCell> cells() const { return cells_; }
    // Returns the index in cells(), or -1 if the place is outside the grid or not strong.
    [[nodiscard]] std::int32_t at(int ix, int iy, int iz) const {
        if (ix < 0 || iy < 0 || iz < 0 || ix >= nx_ || iy >= ny_ || iz >= nz_) return -1;
        constexpr int edge = grid::brick_edge;
        const std::size_t brick =
            (static_cast<std::size_t>(ix / edge) * static_cast<std::size_t>(bricks_y_) +
             static_cast<std::size_t>(iy / edge)) *
                static_cast<std::size_t>(bricks_z_) +
            static_cast<std::size_t>(iz / edge);
        const std::int32_t slot = slots_[brick];
        if (slot < 0) return -1;
        const int within = (ix % edge * edge + iy % edge) * edge + iz % edge;
        return index_[static_cast<std::size_t>(slot) * grid::brick_cells +
                      static_cast<std::size_t>(within)];
    }
    // Returns the reflectivity of a level, which is up to one step below the reflectivity of its
    // cells.
    [[nodiscard]] float dbz_of(std::uint8_t level) const {
        return least_dbz_ + level_step_db * static_cast<float>(level - 1);
    }

  private:
    void collect(const grid::BrickView& view, const std::vector<std::uint8_t>& levels);
    void sort_by_level();

    int nx_, ny_, nz_, bricks_y_, bricks_z_;
    float least_dbz_;
    std::vector<std::int32_t> slots_;  // for each brick, its place in index_, or -1
    std::vector<std::int32_t> index_;  // for each cell of a strong brick, its place in cells_, or
                                       // -1
    std::vector<StrongGridCell> cells_;
};

}  // namespace stormcellar::retrieve
