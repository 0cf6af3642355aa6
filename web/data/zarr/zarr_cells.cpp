#include "web/data/zarr/zarr_cells.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "render/still/map_attributes.h"

namespace stormcellar::web {
namespace {

using grid::brick_edge;
using grid::BrickKind;
using grid::CellStatus;

using zarr::Stretch;
using zarr::stretch_of;

struct ChunkCells {
    Stretch z, y, x;
    std::size_t levels = 0;  // number of levels in the chunk

    ChunkCells(const grid::GridSpec& spec, const ChunkPlace& place)
        : z(stretch_of(place.z, chunk_levels(spec), spec.nz())),
          y(stretch_of(place.y, chunk_side, spec.ny)),
          x(stretch_of(place.x, chunk_side, spec.nx)),
          levels(static_cast<std::size_t>(chunk_levels(spec))) {}
    [[nodiscard]] std::size_t count() const { return levels * chunk_side * chunk_side; }
    [[nodiscard]] std::size_t index(int ix, int iy, int iz) const {
        return (static_cast<std::size_t>(iz - z.first) * chunk_side +
                static_cast<std::size_t>(iy - y.first)) *
                   chunk_side +
               static_cast<std::size_t>(ix - x.first);
    }
};

Stretch within_brick(int brick, const Stretch& cells) {
    return {std::max(brick * brick_edge, cells.first),
            std::min((brick + 1) * brick_edge, cells.end)};
}

// Calls `brick(entry, x, y, z)` for each brick, with the ranges of its cells that are in the chunk.
template <class Brick>
void for_each_brick(const grid::BrickView& view, const ChunkCells& cells, const Brick& brick) {
    for (int bx = cells.x.first / brick_edge; bx * brick_edge < cells.x.end; ++bx) {
        for (int by = cells.y.first / brick_edge; by * brick_edge < cells.y.end; ++by) {
            for (int bz = cells.z.first / brick_edge; bz * brick_edge < cells.z.end; ++bz) {
                brick(view.bricks[view.brick_index(bx, by, bz)], within_brick(bx, cells.x),
                      within_brick(by, cells.y), within_brick(bz, cells.z));
            }
        }
    }
}

template <class Cell>
void for_each_cell(const Stretch& x, const Stretch& y, const Stretch& z, const Cell& cell) {
    for (int iz = z.first; iz < z.end; ++iz)
        for (int iy = y.first; iy < y.end; ++iy)
            for (int ix = x.first; ix < x.end; ++ix)
                cell(ix, iy, iz);
}

// Calls `column(index in the chunk, place in the field)` for each column of the chunk.
template <class Column>
void for_each_column_of(const render::FlatField& field, const ChunkPlace& place,
                        const Column& column) {
    const Stretch rows = stretch_of(place.y, chunk_side, field.height);
    const Stretch columns = stretch_of(place.x, chunk_side, field.width);
    for (int iy = rows.first; iy < rows.end; ++iy)
        for (int ix = columns.first; ix < columns.end; ++ix)
            column(static_cast<std::size_t>(iy - rows.first) * chunk_side +
                       static_cast<std::size_t>(ix - columns.first),
                   field.index(ix, iy));
}

}  // namespace

std::string value_chunk(const grid::BrickView& view, const ChunkPlace& place) {
    const ChunkCells cells(*view.spec, place);
    std::vector<float> values(cells.count(), std::numeric_limits<float>::quiet_NaN());
    for_each_brick(
        view, cells,
        [&](const grid::BrickEntry& entry, const Stretch& x, const Stretch& y, const Stretch& z) {
            if (entry.kind != BrickKind::stored) return;
            for_each_cell(x, y, z, [&](int ix, int iy, int iz) {
                const std::uint16_t code =
                    view.code_at(view.offset_x(ix) + view.offset_y(iy) + view.offset_z(iz));
                if (code >= view.quantization.first_code())
                    values[cells.index(ix, iy, iz)] = view.quantization.value_of(code);
            });
        });
    return zarr::bytes_of(values);
}

std::string status_chunk(const grid::BrickView& view, const ChunkPlace& place) {
    const ChunkCells cells(*view.spec, place);
    std::string states(cells.count(), static_cast<char>(status_unavailable));
    for_each_brick(
        view, cells,
        [&](const grid::BrickEntry& entry, const Stretch& x, const Stretch& y, const Stretch& z) {
            for_each_cell(x, y, z, [&](int ix, int iy, int iz) {
                CellStatus status = entry.uniform_status;
                if (entry.kind == BrickKind::stored) {
                    status = view.quantization.status_of(
                        view.code_at(view.offset_x(ix) + view.offset_y(iy) + view.offset_z(iz)));
                } else if (entry.kind == BrickKind::status_only) {
                    status = view.status(ix, iy, iz);
                }
                states[cells.index(ix, iy, iz)] = static_cast<char>(status);
            });
        });
    return states;
}

std::string map_value_chunk(const FlatMap& map, const ChunkPlace& place) {
    const render::FlatField& field = map.levels.front();
    std::vector<float> values(std::size_t{chunk_side} * chunk_side,
                              std::numeric_limits<float>::quiet_NaN());
    for_each_column_of(field, place, [&](std::size_t at, std::size_t column) {
        if (field.status[column] == CellStatus::value) values[at] = field.values[column];
    });
    return zarr::bytes_of(values);
}

std::string map_status_chunk(const FlatMap& map, const ChunkPlace& place) {
    const render::FlatField& field = map.levels.front();
    std::string states(std::size_t{chunk_side} * chunk_side,
                       static_cast<char>(map_status_unavailable));
    for_each_column_of(field, place, [&](std::size_t at, std::size_t column) {
        const bool at_least = !map.at_least.empty() && map.at_least[column] != 0;
        states[at] = static_cast<char>(render::state_code(field.status[column], at_least));
    });
    return states;
}

}  // namespace stormcellar::web
