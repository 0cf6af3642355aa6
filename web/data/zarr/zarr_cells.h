// web/data/zarr/zarr_cells.h -- makes chunks of Zarr arrays from the cells of a grid.
//
// A chunk has `chunk_side` columns and `chunk_side` rows, and all levels, but at most `chunk_side`
// levels. Its dimensions are time (one), z, y and x; x varies fastest. Cells of a chunk that are
// beyond the grid have the fill value. The bytes are uncompressed and little-endian.
//
// Units     Those of the moment.
// Threads   Pure functions.
// Errors    None. The chunk must be within the grid.
// Accuracy  The values equal those of grid::to_dense() bit by bit.
#pragma once

#include <cstdint>
#include <string>

#include "stormcellar/grid/brick_view.h"
#include "web/data/pictures/flat_map.h"

namespace stormcellar::web {

inline constexpr int chunk_side = 128;
static_assert(chunk_side % grid::brick_edge == 0);
// The fill value of states means that the grid is gone or cannot be read. No cell has this state.
// So a reader that treats an error as a missing chunk does not show "not seen".
inline constexpr std::int8_t status_unavailable = 4;

struct ChunkPlace {
    int z = 0, y = 0, x = 0;  // number of the chunk along each axis
};
[[nodiscard]] constexpr int chunks_along(int cells) {
    return (cells + chunk_side - 1) / chunk_side;
}
[[nodiscard]] int chunk_levels(const grid::GridSpec& spec);

// Returns the values as float32; NaN if the cell has no value.
[[nodiscard]] std::string value_chunk(const grid::BrickView& view, const ChunkPlace& place);
// Returns the states of the cells as int8 numbers.
[[nodiscard]] std::string status_chunk(const grid::BrickView& view, const ChunkPlace& place);

// The same for 2D products, whose states include `value_or_more` (4), so that another flag means
// unavailable. A chunk has `chunk_side` columns and rows of the map's full resolution.
inline constexpr std::int8_t map_status_unavailable = 6;
[[nodiscard]] std::string map_value_chunk(const FlatMap& map, const ChunkPlace& place);
[[nodiscard]] std::string map_status_chunk(const FlatMap& map, const ChunkPlace& place);

// Selects what position_chunk() returns: the latitude or the longitude of the middle of each column
// of cells. Positions are in degrees, as in grid files (export/grid_coordinates.h). A chunk has
// `chunk_side` rows and columns of float64; NaN beyond the grid.
enum class Position { latitude, longitude };
[[nodiscard]] std::string position_chunk(const grid::GridSpec& spec, Position which,
                                         const ChunkPlace& place);

}  // namespace stormcellar::web
