// export/zarr_chunks.h -- makes chunks of Zarr arrays; internal.
//
// A chunk is uncompressed and little-endian. Numbers of a chunk that are beyond the array have the
// fill value.
//
// Threads   Pure functions.
// Errors    None. The chunk must be within the array.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <string>
#include <vector>

#include "export/zarr_layout.h"
#include "stormcellar/grid/grid_spec.h"

namespace stormcellar::zarr {

struct ChunkPlace {
    int z = 0, y = 0, x = 0;  // number of the chunk along each axis
};
[[nodiscard]] constexpr int chunks_along(int cells) {
    return (cells + chunk_side - 1) / chunk_side;
}

// The cells of a chunk that are within the grid, along one axis.
struct Stretch {
    int first = 0, end = 0;
};
[[nodiscard]] inline Stretch stretch_of(int chunk, int side, int cells) {
    return {chunk * side, std::min((chunk + 1) * side, cells)};
}

template <class Number>
[[nodiscard]] std::string bytes_of(const std::vector<Number>& numbers) {
    std::string bytes(numbers.size() * sizeof(Number), '\0');
    std::memcpy(bytes.data(), numbers.data(), bytes.size());
    return bytes;
}

// Returns `length` numbers of an axis from `first` on, as float64; NaN beyond its end.
[[nodiscard]] std::string axis_chunk(const std::vector<double>& numbers, std::size_t first,
                                     std::size_t length);

// Selects what position_chunk() returns: the latitude or the longitude of the middle of each column
// of cells. Positions are in degrees, as in grid files (export/grid_coordinates.h). A chunk has
// `chunk_side` rows and columns of float64; NaN beyond the grid.
enum class Position { latitude, longitude };
[[nodiscard]] std::string position_chunk(const grid::GridSpec& spec, Position which,
                                         const ChunkPlace& place);

}  // namespace stormcellar::zarr
