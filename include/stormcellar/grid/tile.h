// stormcellar/grid/tile.h -- tiles of columns, and their bounds as the site sees them.
//
// A grid is filled tile by tile, because neighboring columns need gates that are close together in
// memory, and because a sweep that shows no echo anywhere over a tile need not be sampled there.
//
// Units     Degrees and meters.
// Threads   Plain values and pure functions.
// Errors    None.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

namespace stormcellar::grid {

struct ColumnPlace;
class ColumnGeometry;

inline constexpr int tile_edge = 8;

// Bounds that hold every column of a tile. Azimuths run clockwise from `from_deg`, in [0, 360), to
// `to_deg`, which may exceed 360. They cover 0 to 360 if the tile surrounds the site or is near it.
struct PolarBounds {
    float from_deg = 0;
    float to_deg = 360;
    float least_arc_m = 0;
    float greatest_arc_m = 0;

    // Returns bounds that reach farther on each side.
    [[nodiscard]] PolarBounds widened(float by_deg, float by_m) const;
};

struct Tile {
    int first_x = 0, end_x = 0;  // columns
    int first_y = 0, end_y = 0;  // rows
    PolarBounds bounds;
};

[[nodiscard]] std::vector<Tile> make_tiles(const ColumnGeometry& geometry);

}  // namespace stormcellar::grid
