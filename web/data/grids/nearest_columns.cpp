#include "web/data/grids/nearest_columns.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <span>

#include "stormcellar/grid/projection.h"

namespace stormcellar::web {
namespace {

constexpr std::size_t brick_side = grid::brick_edge;

// Copies the part of a column that is in one layer of bricks. These are sixteen codes, or fewer at
// the top of the grid.
template <class Code>
void copy_column(const grid::BrickView& from, int x, int y, int bz, Code* to, int levels) {
    const std::size_t brick = from.brick_index(x / grid::brick_edge, y / grid::brick_edge, bz);
    const grid::BrickEntry& entry = from.bricks[brick];
    const std::size_t first = (static_cast<std::size_t>(x) % brick_side * brick_side +
                               static_cast<std::size_t>(y) % brick_side) *
                              brick_side;
    switch (entry.kind) {
        case grid::BrickKind::uniform:
            std::fill_n(to, levels, static_cast<Code>(entry.uniform_status));
            break;
        case grid::BrickKind::status_only:
            for (std::size_t z = 0; z < static_cast<std::size_t>(levels); ++z) {
                const auto four = std::to_integer<unsigned>(
                    from.states[(entry.status_index * grid::brick_cells + first + z) / 4]);
                to[z] = static_cast<Code>(four >> (2 * ((first + z) % 4)) & 3U);
            }
            break;
        case grid::BrickKind::stored:
            std::memcpy(to, from.codes.data() + (brick * grid::brick_cells + first) * sizeof(Code),
                        static_cast<std::size_t>(levels) * sizeof(Code));
            break;
    }
}

}  // namespace

NearestColumns::NearestColumns(const grid::GridSpec& from, const grid::GridSpec& plane)
    : plane_(plane), columns_(plane.column_count()) {
    const grid::GridProjection here(from), there(plane);
    auto column = columns_.begin();
    for (int ix = 0; ix < plane.nx; ++ix) {
        for (int iy = 0; iy < plane.ny; ++iy, ++column) {
            const grid::GeoPoint place =
                there.to_geo({static_cast<double>(ix), static_cast<double>(iy)});
            const grid::ColumnPoint at = here.to_column(place);
            const double x = std::round(at.x), y = std::round(at.y);
            if (!(x >= 0) || !(y >= 0) || x >= from.nx || y >= from.ny) continue;
            *column = {static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)};
        }
    }
}

template <class Code>
void NearestColumns::lay(const grid::BrickView& from, grid::BrickGrid& laid) const {
    const grid::BrickView shape = laid.view();
    grid::BricksWriter writer(laid);
    std::array<Code, grid::brick_cells> codes;
    for (int bx = 0; bx < shape.bricks_x; ++bx) {
        for (int by = 0; by < shape.bricks_y; ++by) {
            for (int bz = 0; bz < shape.bricks_z; ++bz) {
                const grid::BrickExtent extent = grid::brick_extent(plane_, bx, by, bz);
                codes.fill(0);
                for (int x = 0; x < extent.x; ++x) {
                    for (int y = 0; y < extent.y; ++y) {
                        const auto column = static_cast<std::size_t>(bx * grid::brick_edge + x) *
                                                static_cast<std::size_t>(plane_.ny) +
                                            static_cast<std::size_t>(by * grid::brick_edge + y);
                        const Column at = columns_[column];
                        if (at.x < 0) continue;
                        const std::size_t to = (static_cast<std::size_t>(x) * brick_side +
                                                static_cast<std::size_t>(y)) *
                                               brick_side;
                        copy_column(from, at.x, at.y, bz, &codes[to], extent.z);
                    }
                }
                writer.put_codes(shape.brick_index(bx, by, bz), codes.data(), extent);
            }
        }
    }
    laid.finish(std::span(&writer, 1));
}

grid::BrickGrid NearestColumns::lay(const grid::BrickView& from) const {
    grid::BrickGrid laid(plane_, from.quantization);
    if (from.quantization.code_bytes == 1) {
        lay<std::uint8_t>(from, laid);
    } else {
        lay<std::uint16_t>(from, laid);
    }
    return laid;
}

}  // namespace stormcellar::web
