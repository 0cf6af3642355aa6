#include "export/zarr_chunks.h"

#include <bit>
#include <limits>

#include "stormcellar/grid/projection.h"

namespace stormcellar::zarr {

static_assert(std::endian::native == std::endian::little, "chunks are little-endian");

std::string axis_chunk(const std::vector<double>& numbers, std::size_t first, std::size_t length) {
    std::vector<double> chunk(length, std::numeric_limits<double>::quiet_NaN());
    for (std::size_t i = 0; i < length && first + i < numbers.size(); ++i)
        chunk[i] = numbers[first + i];
    return bytes_of(chunk);
}

std::string position_chunk(const grid::GridSpec& spec, Position which, const ChunkPlace& place) {
    const grid::GridProjection projection(spec);
    std::vector<double> degrees(std::size_t{chunk_side} * chunk_side,
                                std::numeric_limits<double>::quiet_NaN());
    const Stretch rows = stretch_of(place.y, chunk_side, spec.ny);
    const Stretch columns = stretch_of(place.x, chunk_side, spec.nx);
    for (int iy = rows.first; iy < rows.end; ++iy) {
        for (int ix = columns.first; ix < columns.end; ++ix) {
            const grid::GeoPoint point = projection.to_geo({1.0 * ix, 1.0 * iy});
            const auto at = static_cast<std::size_t>(iy - rows.first) * chunk_side +
                            static_cast<std::size_t>(ix - columns.first);
            degrees[at] = which == Position::latitude
                              ? point.latitude_deg
                              : projection.continuous_longitude_deg(point.longitude_deg);
        }
    }
    return bytes_of(degrees);
}

}  // namespace stormcellar::zarr
