#include "export/grid_zarr.h"

#include <limits>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/ranges.h>

#include "base/atomic_directory.h"
#include "export/cell_order.h"
#include "export/grid_fields.h"
#include "export/gzip_bytes.h"
#include "export/zarr_chunks.h"

namespace stormcellar::zarr {
namespace {

namespace fs = std::filesystem;
using netcdf::GridField;

constexpr std::string_view when_unavailable =
    "unavailable: a file of the store is missing; nothing is known of the cell";

Status is_group_or_empty(const fs::path& directory) {
    std::error_code error;
    const bool is_replaceable = fs::exists(directory / ".zgroup", error) ||
                                fs::exists(directory / "zarr.json", error) ||
                                fs::is_empty(directory, error);
    if (error) return fail(ErrorCode::io, "{}", error.message());
    if (is_replaceable) return {};
    return fail(ErrorCode::bad_argument,
                "holds files but is not a Zarr group; name a new or empty directory");
}

ZarrNumber number_of(GridField::Kind kind) {
    switch (kind) {
        case GridField::Kind::value:
        case GridField::Kind::detail:
        case GridField::Kind::site_weight:
            return ZarrNumber::float32;
        case GridField::Kind::status:
            return ZarrNumber::int8;
        case GridField::Kind::site_count:
            return ZarrNumber::int16;
    }
    return ZarrNumber::float32;
}

ZarrArray array_of(const GridField& field) {
    constexpr int unknown_count = -1;
    ZarrArray array = array_of_cells(field.grid->spec, 1);
    array.name = field.name;
    array.number = number_of(field.kind);
    array.attributes = json_of(field.attributes);
    place_on_map(array, field.grid->spec);
    if (array.number == ZarrNumber::int16) array.fill = unknown_count;
    if (field.flags.empty()) return array;
    add_flags(array, {.values = {field.flags.begin(), field.flags.end()},
                      .meanings = field.flag_meanings + " ",
                      .comment = when_unavailable});
    return array;
}

template <class Number>
std::string cells_of(const GridField& field, const ChunkPlace& place, Number fill) {
    const grid::GridSpec& spec = field.grid->spec;
    const int levels = chunk_levels(spec);
    const Stretch x = stretch_of(place.x, chunk_side, spec.nx);
    const Stretch y = stretch_of(place.y, chunk_side, spec.ny);
    const Stretch z = stretch_of(place.z, levels, spec.nz());
    std::vector<Number> cells(static_cast<std::size_t>(levels) * chunk_side * chunk_side, fill);
    const CellBox box{x.first, x.end, y.first, y.end, z.first, z.end, chunk_side, chunk_side};
    const auto number = [&](std::size_t cell) {
        return static_cast<Number>(field.number(cell, std::numeric_limits<float>::quiet_NaN()));
    };
    copy_in_file_order(spec, box, number, cells.data());
    return bytes_of(cells);
}

std::string field_chunk(const GridField& field, const ZarrArray& array, const ChunkPlace& place) {
    if (array.number == ZarrNumber::int8)
        return cells_of(field, place, array.fill.get<std::int8_t>());
    if (array.number == ZarrNumber::int16)
        return cells_of(field, place, array.fill.get<std::int16_t>());
    return cells_of(field, place, std::numeric_limits<float>::quiet_NaN());
}

// Writes the documents and chunks of one version of the format into a directory.
class StoreWriter {
  public:
    StoreWriter(AtomicDirectory& directory, ZarrVersion version)
        : directory_(directory), version_(version) {}

    Status write_group(const ZarrGroup& group) {
        if (version_ == ZarrVersion::three) return write_document("zarr.json", zarr3_of(group));
        if (Status done = write_document(".zgroup", {{"zarr_format", 2}}); !done) return done;
        if (Status done = write_document(".zattrs", group.attributes); !done) return done;
        return write_document(".zmetadata", zmetadata_of(group));
    }

    Status write_array(const ZarrArray& array) {
        const fs::path name = array.name;
        if (version_ == ZarrVersion::three)
            return write_document(name / "zarr.json", zarr3_of(array));
        if (Status done = write_document(name / ".zarray", zarray_of(array)); !done) return done;
        return write_document(name / ".zattrs", zattrs_of(array));
    }

    Status write_chunk(const ZarrArray& array, const std::vector<std::size_t>& place,
                       std::string_view bytes) {
        const auto packed = gzip_bytes(bytes, gzip_level);
        if (!packed) return pass_on(packed);
        const bool is_three = version_ == ZarrVersion::three;
        std::string key = fmt::format("{}", fmt::join(place, is_three ? "/" : "."));
        if (is_three) key = place.empty() ? "c" : "c/" + key;
        if (key.empty()) key = "0";  // the chunk of a scalar, in version 2
        return directory_.write(fs::path(array.name) / key, std::as_bytes(std::span(*packed)));
    }

  private:
    Status write_document(const fs::path& name, const ZarrJson& document) {
        const std::string text = text_of(document);
        return directory_.write(name, std::as_bytes(std::span(text)));
    }

    AtomicDirectory& directory_;
    const ZarrVersion version_;
};

Status write_field(StoreWriter& store, const GridField& field, const ZarrArray& array) {
    if (Status done = store.write_array(array); !done) return done;
    for (std::size_t z = 0; z < array.chunks_along(1); ++z) {
        for (std::size_t y = 0; y < array.chunks_along(2); ++y) {
            for (std::size_t x = 0; x < array.chunks_along(3); ++x) {
                const ChunkPlace place{static_cast<int>(z), static_cast<int>(y),
                                       static_cast<int>(x)};
                Status done =
                    store.write_chunk(array, {0, z, y, x}, field_chunk(field, array, place));
                if (!done) return done;
            }
        }
    }
    return {};
}

// Writes lat and lon of each column.
Status write_positions(StoreWriter& store, const grid::GridSpec& spec, const ZarrArray& array) {
    const auto which = array.name == "lat" ? Position::latitude : Position::longitude;
    for (std::size_t y = 0; y < array.chunks_along(0); ++y) {
        for (std::size_t x = 0; x < array.chunks_along(1); ++x) {
            const ChunkPlace place{0, static_cast<int>(y), static_cast<int>(x)};
            Status done = store.write_chunk(array, {y, x}, position_chunk(spec, which, place));
            if (!done) return done;
        }
    }
    return {};
}

// Writes an array that has no cells: a coordinate, a position or the grid mapping.
Status write_place(StoreWriter& store, const grid::Grid& grid, const ZarrArray& array) {
    const grid::GridSpec& spec = grid.spec;
    if (Status done = store.write_array(array); !done) return done;
    if (array.dimensions.empty())
        return store.write_chunk(array, {}, std::string(sizeof(std::int32_t), '\0'));
    if (array.dimensions.size() == 2) return write_positions(store, spec, array);
    std::vector<double> numbers = netcdf::column_places(spec);
    if (array.name == "time") {
        numbers = {netcdf::seconds_of(grid)};
    } else if (array.name == "z") {
        numbers = spec.levels_m;
    } else if (array.name == netcdf::map_names(spec).y) {
        numbers = netcdf::row_places(spec);
    }
    return store.write_chunk(array, {0}, axis_chunk(numbers, 0, array.chunk[0]));
}

Status write_all(StoreWriter& store, std::span<const grid::Grid> grids) {
    const grid::Grid& grid = grids.front();
    ZarrGroup group;
    group.attributes = json_of(netcdf::provenance_attributes(grids));
    for (const GridField& field : netcdf::fields_of(grids)) {
        group.arrays.push_back(array_of(field));
        if (Status done = write_field(store, field, group.arrays.back()); !done) return done;
    }
    const std::size_t cell_arrays = group.arrays.size();
    group.arrays.push_back(axis("time", 1, 1, netcdf::time_attributes(netcdf::time_name(grid))));
    group.arrays.push_back(axis("z", grid.spec.levels_m.size(), grid.spec.levels_m.size(),
                                netcdf::height_attributes()));
    for (ZarrArray& array : map_arrays(grid.spec))
        group.arrays.push_back(std::move(array));
    for (const ZarrArray& array : std::span(group.arrays).subspan(cell_arrays)) {
        if (Status done = write_place(store, grid, array); !done) return done;
    }
    return store.write_group(group);
}

Status write_to(FileSystem& file_system, const fs::path& path, std::span<const grid::Grid> grids,
                ZarrVersion version) {
    auto directory = AtomicDirectory::create(file_system, path, is_group_or_empty);
    if (!directory) return pass_on(directory);
    StoreWriter store(*directory, version);
    if (Status done = write_all(store, grids); !done) return done;
    return directory->commit();
}

// Puts the path before a message that lacks it.
Status name_store(Status status, const fs::path& path) {
    if (!status && !status.error().message.starts_with(path.native()))
        status.error().message = fmt::format("{}: {}", path.native(), status.error().message);
    return status;
}

}  // namespace

Status check_store(const fs::path& path) {
    return name_store(AtomicDirectory::check(path, is_group_or_empty), path);
}

Status write_store(FileSystem& file_system, const fs::path& path, std::span<const grid::Grid> grids,
                   ZarrVersion version) {
    if (Status good = netcdf::check_grids(grids); !good) return good;
    return name_store(write_to(file_system, path, grids, version), path);
}

}  // namespace stormcellar::zarr
