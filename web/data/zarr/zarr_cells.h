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

#include "export/zarr_chunks.h"
#include "stormcellar/grid/brick_view.h"
#include "web/data/pictures/flat_map.h"

namespace stormcellar::web {

using zarr::chunk_levels;
using zarr::chunk_side;
using zarr::ChunkPlace;
using zarr::chunks_along;
using zarr::status_unavailable;
static_assert(chunk_side % grid::brick_edge == 0);

// Returns the values as float32; NaN if the cell has no value.
[[nodiscard]] std::string value_chunk(const grid::BrickView& view, const ChunkPlace& place);
// Returns the states of the cells as int8 numbers.
[[nodiscard]] std::string status_chunk(const grid::BrickView& view, const ChunkPlace& place);

// The same for 2D products, whose states include `value_or_more` (4), so that another flag means
// unavailable. A chunk has `chunk_side` columns and rows of the map's full resolution.
inline constexpr std::int8_t map_status_unavailable = 6;
[[nodiscard]] std::string map_value_chunk(const FlatMap& map, const ChunkPlace& place);
[[nodiscard]] std::string map_status_chunk(const FlatMap& map, const ChunkPlace& place);

}  // namespace stormcellar::web
