#include "grid/mosaic/echo_image.h"

#include <algorithm>
#include <array>

namespace stormcellar::grid {
namespace {

// The columns of one brick seen from above: 0 for not seen, 1 for seen without echo, else the
// greatest code.
using BrickTop = std::array<std::uint16_t, static_cast<std::size_t>(brick_edge) * brick_edge>;

void add_stored(const BrickView& view, std::size_t brick, int first_level, BrickTop& top) {
    std::size_t offset = brick * brick_cells;
    for (std::uint16_t& column : top) {
        for (int z = 0; z < brick_edge; ++z, ++offset) {
            if (z < first_level) continue;
            const std::uint16_t code = view.code_at(offset);
            if (code != 0) column = std::max<std::uint16_t>(column, code == 2 ? 1 : code);
        }
    }
}

void add_states(const BrickView& view, const BrickEntry& entry, int first_level, BrickTop& top) {
    const std::size_t block = entry.status_index * state_block_bytes;
    std::size_t cell = 0;
    for (std::uint16_t& column : top) {
        for (int z = 0; z < brick_edge; ++z, ++cell) {
            const auto four = static_cast<unsigned>(view.states[block + cell / 4]);
            const bool seen = ((four >> (2 * (cell % 4))) & 3U) != 0;
            if (seen && z >= first_level) column = std::max<std::uint16_t>(column, 1);
        }
    }
}

BrickTop top_of(const BrickView& view, int bx, int by, int lowest_level) {
    BrickTop top{};
    for (int bz = 0; bz < view.bricks_z; ++bz) {
        const int first = lowest_level - bz * brick_edge;
        if (first >= brick_edge) continue;
        const std::size_t brick = view.brick_index(bx, by, bz);
        const BrickEntry& entry = view.bricks[brick];
        if (entry.kind == BrickKind::stored) {
            add_stored(view, brick, first, top);
        } else if (entry.kind == BrickKind::status_only) {
            add_states(view, entry, first, top);
        } else if (entry.uniform_status != CellStatus::not_seen) {
            for (std::uint16_t& column : top)
                column = std::max<std::uint16_t>(column, 1);
        }
    }
    return top;
}

int lowest_level_of(const GridSpec& spec, double lowest_m) {
    const auto first = std::lower_bound(spec.levels_m.begin(), spec.levels_m.end(), lowest_m);
    return first == spec.levels_m.end() ? 0 : static_cast<int>(first - spec.levels_m.begin());
}

// Divides the sum in each pixel by the number of its seen columns, and decides whether the pixel is
// seen.
void divide(EchoImage& image, const std::vector<std::uint32_t>& columns,
            const std::vector<std::uint32_t>& seen) {
    for (std::size_t at = 0; at < image.seen.size(); ++at) {
        image.seen[at] = columns[at] > 0 && 2 * seen[at] >= columns[at] ? 1 : 0;
        image.echo_db[at] =
            image.seen[at] != 0 ? image.echo_db[at] / static_cast<float>(seen[at]) : 0;
    }
}

}  // namespace

EchoImage echo_image(const BrickView& view, const EchoImageOptions& options) {
    const GridSpec& spec = *view.spec;
    EchoImage image;
    image.cells = options.cells;
    image.width = (spec.nx + options.cells - 1) / options.cells;
    image.height = (spec.ny + options.cells - 1) / options.cells;
    const std::size_t pixels = image.index(0, image.height);
    image.echo_db.resize(pixels);
    image.seen.resize(pixels);
    std::vector<std::uint32_t> columns(pixels), seen(pixels);
    const int lowest = lowest_level_of(spec, options.lowest_m);
    for (int bx = 0; bx < view.bricks_x; ++bx) {
        for (int by = 0; by < view.bricks_y; ++by) {
            const BrickTop top = top_of(view, bx, by, lowest);
            for (std::size_t column = 0; column < top.size(); ++column) {
                const int ix = bx * brick_edge + static_cast<int>(column) / brick_edge;
                const int iy = by * brick_edge + static_cast<int>(column) % brick_edge;
                if (ix >= spec.nx || iy >= spec.ny) continue;
                const std::size_t at = image.index(ix / options.cells, iy / options.cells);
                ++columns[at];
                if (top[column] == 0) continue;
                ++seen[at];
                if (top[column] < first_value_code) continue;
                const float dbz = view.quantization.value_of(top[column]);
                image.echo_db[at] += std::max(0.0F, dbz - options.floor_dbz);
            }
        }
    }
    divide(image, columns, seen);
    return image;
}

EchoImage halved(const EchoImage& image) {
    EchoImage half;
    half.cells = 2 * image.cells;
    half.width = (image.width + 1) / 2;
    half.height = (image.height + 1) / 2;
    const std::size_t pixels = half.index(0, half.height);
    half.echo_db.resize(pixels);
    half.seen.resize(pixels);
    std::vector<std::uint32_t> columns(pixels), seen(pixels);
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const std::size_t at = half.index(x / 2, y / 2);
            ++columns[at];
            if (image.seen[image.index(x, y)] == 0) continue;
            ++seen[at];
            half.echo_db[at] += image.echo_db[image.index(x, y)];
        }
    }
    divide(half, columns, seen);
    return half;
}

}  // namespace stormcellar::grid
