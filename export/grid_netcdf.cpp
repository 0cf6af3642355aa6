#include "stormcellar/export/grid_netcdf.h"

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include <netcdf.h>

#include "export/cell_order.h"
#include "export/grid_coordinates.h"
#include "export/grid_fields.h"
#include "export/netcdf_builder.h"

namespace stormcellar::netcdf {
namespace {

using grid::Grid;

constexpr std::size_t largest_chunk_side = 512;

struct Dimensions {
    int time, z, y, x;
};

// Returns the numbers of the cells in the order of the file: x fastest, then y, then z.
template <class Cell>
std::vector<Cell> in_file_order(const GridField& field, float fill) {
    const grid::GridSpec& spec = field.grid->spec;
    std::vector<Cell> cells(spec.cell_count());
    const CellBox all{.end_x = spec.nx,
                      .end_y = spec.ny,
                      .end_z = spec.nz(),
                      .row = static_cast<std::size_t>(spec.nx),
                      .rows = static_cast<std::size_t>(spec.ny)};
    const auto number = [&](std::size_t cell) {
        return static_cast<Cell>(field.number(cell, fill));
    };
    copy_in_file_order(spec, all, number, cells.data());
    return cells;
}

void write_axes(NetcdfBuilder& file, const Grid& grid, const Dimensions& size) {
    const int time = file.variable("time", NC_DOUBLE, {size.time});
    write_attributes(file, time, time_attributes(time_name(grid)));
    const int z = file.variable("z", NC_DOUBLE, {size.z});
    write_attributes(file, z, height_attributes());
    // A file has only one time. Without this, netCDF's chunk for an unlimited dimension would take
    // 4 kB.
    file.chunks(time, {1});
    file.write_first(time, seconds_of(grid));
    file.write(z, std::span(grid.spec.levels_m));
    write_map_axes(file, grid.spec, {size.y, size.x});
}

int define_field(NetcdfBuilder& file, const std::string& name, int type, const Dimensions& size,
                 const grid::GridSpec& spec, int deflate_level) {
    const int variable = file.variable(name.c_str(), type, {size.time, size.z, size.y, size.x});
    file.chunks(variable, {1, 1, std::min<std::size_t>(spec.ny, largest_chunk_side),
                           std::min<std::size_t>(spec.nx, largest_chunk_side)});
    file.deflate(variable, deflate_level);
    refer_to_map(file, variable, spec);
    return variable;
}

int type_of(GridField::Kind kind) {
    switch (kind) {
        case GridField::Kind::value:
        case GridField::Kind::detail:
        case GridField::Kind::site_weight:
            return NC_FLOAT;
        case GridField::Kind::status:
            return NC_BYTE;
        case GridField::Kind::site_count:
            return NC_SHORT;
    }
    return NC_NAT;
}

void write_field(NetcdfBuilder& file, const GridField& field, const Dimensions& size,
                 int deflate_level) {
    const int type = type_of(field.kind);
    const int variable =
        define_field(file, field.name, type, size, field.grid->spec, deflate_level);
    constexpr float fill = NC_FILL_FLOAT;
    if (field.has_fill()) file.fill_value(variable, fill);
    write_attributes(file, variable, field.attributes);
    if (!field.flags.empty()) {
        file.bytes(variable, "flag_values", field.flags);
        file.text(variable, "flag_meanings", field.flag_meanings);
    }
    if (type == NC_BYTE) {
        const auto cells = in_file_order<signed char>(field, fill);
        file.write(variable, std::span(cells));
    } else if (type == NC_SHORT) {
        const auto cells = in_file_order<int>(field, fill);
        file.write(variable, std::span(cells));
    } else {
        const auto cells = in_file_order<float>(field, fill);
        file.write(variable, std::span(cells));
    }
}

Status check(std::span<const Grid> grids, const GridWriteOptions& options) {
    if (auto good = check_grids(grids); !good) return good;
    if (options.deflate_level < 0 || options.deflate_level > 9) {
        return fail(ErrorCode::bad_argument, "the deflate level must be 0 to 9, not {}",
                    options.deflate_level);
    }
    return {};
}

Result<std::vector<std::byte>> build(std::span<const Grid> grids, const GridWriteOptions& options) {
    const MutexLock lock(library_mutex());
    NetcdfBuilder file;
    const grid::GridSpec& spec = grids.front().spec;
    const MapNames names = map_names(spec);
    // The dimension `time` is unlimited, so that programs can join files along it (ncrcat). The
    // axes are written first, because write_axes() gives this dimension its one element.
    constexpr std::size_t unlimited = 0;
    const Dimensions size{file.dimension("time", unlimited),
                          file.dimension("z", spec.levels_m.size()),
                          file.dimension(names.y, static_cast<std::size_t>(spec.ny)),
                          file.dimension(names.x, static_cast<std::size_t>(spec.nx))};
    write_attributes(file, NetcdfBuilder::file, provenance_attributes(grids));
    write_axes(file, grids.front(), size);
    write_mapping(file, spec);
    write_positions(file, spec, {size.y, size.x}, options.deflate_level);
    for (const GridField& field : fields_of(grids))
        write_field(file, field, size, options.deflate_level);
    return file.finish();
}

}  // namespace

Result<std::vector<std::byte>> grid_file_bytes(std::span<const Grid> grids,
                                               const GridWriteOptions& options) {
    if (auto good = check(grids, options); !good) return pass_on(good);
    return build(grids, options);
}

Status write_grids(FileSystem& file_system, const std::filesystem::path& path,
                   std::span<const Grid> grids, const GridWriteOptions& options) {
    const auto bytes = grid_file_bytes(grids, options);
    if (!bytes && bytes.error().code == ErrorCode::bad_argument) return pass_on(bytes);
    if (!bytes) return fail(bytes.error().code, "{}: {}", path.string(), bytes.error().message);
    return write_file_atomically(file_system, path, *bytes);
}

Status write_grid(FileSystem& file_system, const std::filesystem::path& path, const Grid& grid,
                  const GridWriteOptions& options) {
    return write_grids(file_system, path, {&grid, 1}, options);
}

}  // namespace stormcellar::netcdf
