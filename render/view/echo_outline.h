// render/view/echo_outline.h -- finds where echo is in a grid, or in all grids of a loop.
//
// For each small square of columns, the outline counts the columns that reach each of several
// thresholds, and holds the height of the tops.
//
// Threads   An EchoOutline may be used by one thread at a time.
// Errors    None.
// Cost      Reads every second column along both axes, once, in bricks with values.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "stormcellar/grid/brick_view.h"
#include "stormcellar/grid/grid_spec.h"
#include "stormcellar/level2/moment.h"

namespace stormcellar::render {

class EchoOutline {
  public:
    static constexpr int tile_columns = 4;
    static constexpr std::array<double, 5> thresholds_dbz = {40, 35, 30, 20, 5};
    // Arrays of counts have one place for each threshold, and then one for all columns with a
    // value.
    static constexpr std::size_t all_columns = thresholds_dbz.size();

    EchoOutline() = default;
    EchoOutline(const grid::BrickView& view, level2::Moment moment) { add(view, moment); }
    // Adds a grid. Ignores a grid whose spec differs from the first grid's.
    void add(const grid::BrickView& view, level2::Moment moment);

    // A square of columns: how many of these reach each threshold, how many have a value, and the
    // height above sea level of the highest cell that counts as a top.
    struct Tile {
        std::array<std::int32_t, all_columns + 1> columns{};
        float top_m = 0;
    };
    [[nodiscard]] bool empty() const { return tiles_.empty(); }
    [[nodiscard]] int across() const { return across_; }
    [[nodiscard]] int up() const { return up_; }
    [[nodiscard]] const Tile& tile(int x, int y) const {
        return tiles_[static_cast<std::size_t>(x) * static_cast<std::size_t>(up_) +
                      static_cast<std::size_t>(y)];
    }
    [[nodiscard]] const grid::GridSpec& spec() const { return spec_; }
    // Return the west or the south edge of a tile, in meters from the middle of the grid. For the
    // index after the last tile, this is the edge of the grid.
    [[nodiscard]] double west_m(int x) const;
    [[nodiscard]] double south_m(int y) const;
    // Returns the area that a counted column represents.
    [[nodiscard]] double column_km2() const;
    // Returns the sums of the counts over all tiles.
    [[nodiscard]] std::array<double, all_columns + 1> columns() const;

  private:
    class Reader;
    grid::GridSpec spec_;
    int across_ = 0, up_ = 0;
    std::vector<Tile> tiles_;
};

// Returns true if there is echo, but 20 dBZ covers less than 150 km2 and 30 dBZ less than 60 km2.
// Such echo comes from insects, birds, dust, the ground near the radar, or light snow.
[[nodiscard]] bool is_clear_air(const EchoOutline& outline);

}  // namespace stormcellar::render
