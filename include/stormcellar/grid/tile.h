// stormcellar/grid/tile.h -- tiles of columns, and where they lie as the site sees them.
//
// A grid is filled tile by tile: the gates that neighbouring columns need lie together, and a sweep
// that holds nothing but no echo over a whole tile need not be sampled there.
// Threads: plain values.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

namespace stormcellar::grid {

struct ColumnPlace;
class ColumnGeometry;

inline constexpr int tile_edge = 8;

// Holds every column of a tile: azimuths clockwise from `from_deg` in [0, 360) to `to_deg`, which
// may exceed 360; all of them from 0 to 360 where the tile surrounds or nears the site.
struct PolarBounds {
    float from_deg = 0;
    float to_deg = 360;
    float least_arc_m = 0;
    float greatest_arc_m = 0;

    // Reaching farther to each side.
    [[nodiscard]] PolarBounds widened(float by_deg, float by_m) const;
};

struct Tile {
    int first_x = 0, end_x = 0;  // columns
    int first_y = 0, end_y = 0;  // rows
    PolarBounds bounds;
};

[[nodiscard]] std::vector<Tile> make_tiles(const ColumnGeometry& geometry);

}  // namespace stormcellar::grid
