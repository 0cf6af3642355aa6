#include "stormcellar/grid/tile.h"

#include <cmath>

#include "stormcellar/grid/column_geometry.h"

namespace stormcellar::grid {
namespace {

constexpr float widest_turn_deg = 90;
constexpr float rounding_deg = 1e-4F;

float turn_deg(float from_deg, float to_deg) {
    const float turn = to_deg - from_deg;
    return turn > 180 ? turn - 360 : turn < -180 ? turn + 360 : turn;
}

PolarBounds bounds_of(const ColumnGeometry& geometry, const Tile& tile) {
    const ColumnPlace& first = geometry.row(tile.first_y)[static_cast<std::size_t>(tile.first_x)];
    PolarBounds bounds{0, 360, first.arc_m, first.arc_m};
    float least_turn_deg = 0;
    float greatest_turn_deg = 0;
    for (int iy = tile.first_y; iy < tile.end_y; ++iy) {
        const auto columns =
            geometry.row(iy).subspan(static_cast<std::size_t>(tile.first_x),
                                     static_cast<std::size_t>(tile.end_x - tile.first_x));
        for (const ColumnPlace& place : columns) {
            bounds.least_arc_m = std::min(bounds.least_arc_m, place.arc_m);
            bounds.greatest_arc_m = std::max(bounds.greatest_arc_m, place.arc_m);
            const float turn = turn_deg(first.azimuth_deg, place.azimuth_deg);
            least_turn_deg = std::min(least_turn_deg, turn);
            greatest_turn_deg = std::max(greatest_turn_deg, turn);
        }
    }
    if (greatest_turn_deg - least_turn_deg > widest_turn_deg) return bounds;
    bounds.from_deg = first.azimuth_deg + least_turn_deg;
    bounds.to_deg = first.azimuth_deg + greatest_turn_deg;
    return bounds.widened(rounding_deg, 0);
}

}  // namespace

PolarBounds PolarBounds::widened(float by_deg, float by_m) const {
    PolarBounds wider{from_deg - by_deg, to_deg + by_deg, std::max(0.0F, least_arc_m - by_m),
                      greatest_arc_m + by_m};
    if (wider.to_deg - wider.from_deg >= 359)
        return {0, 360, wider.least_arc_m, wider.greatest_arc_m};
    const float turns = 360 * std::floor(wider.from_deg / 360);
    wider.from_deg -= turns;
    wider.to_deg -= turns;
    if (wider.from_deg >= 360) return {0, 360, wider.least_arc_m, wider.greatest_arc_m};
    return wider;
}

std::vector<Tile> make_tiles(const ColumnGeometry& geometry) {
    const GridSpec& spec = geometry.spec();
    std::vector<Tile> tiles;
    for (int y = 0; y < spec.ny; y += tile_edge) {
        for (int x = 0; x < spec.nx; x += tile_edge) {
            Tile tile{x, std::min(x + tile_edge, spec.nx), y, std::min(y + tile_edge, spec.ny), {}};
            tile.bounds = bounds_of(geometry, tile);
            tiles.push_back(tile);
        }
    }
    return tiles;
}

}  // namespace stormcellar::grid
