#include "export/zarr_layout.h"

#include <algorithm>
#include <utility>
#include <variant>

namespace stormcellar::zarr {
namespace {

struct NumberNames {
    const char* version2;
    const char* version3;
};
NumberNames names_of(ZarrNumber number) {
    switch (number) {
        case ZarrNumber::float32:
            return {"<f4", "float32"};
        case ZarrNumber::float64:
            return {"<f8", "float64"};
        case ZarrNumber::int8:
            return {"|i1", "int8"};
        case ZarrNumber::int16:
            return {"<i2", "int16"};
        case ZarrNumber::int32:
            return {"<i4", "int32"};
        case ZarrNumber::uint8:
            return {"|u1", "uint8"};
        case ZarrNumber::int64:
            return {"<i8", "int64"};
        case ZarrNumber::text:
            return {"|O", "string"};
    }
    return {"", ""};
}

// Returns the codecs of version 3.
ZarrJson codecs_of(const ZarrArray& array) {
    ZarrJson bytes = {{"name", "bytes"}, {"configuration", {{"endian", "little"}}}};
    if (array.number == ZarrNumber::text) bytes = {{"name", "vlen-utf8"}};
    ZarrJson packing = {{"name", "gzip"}, {"configuration", {{"level", gzip_level}}}};
    if (array.packing == ZarrPacking::zstd)
        packing = {{"name", "zstd"},
                   {"configuration", {{"level", zstd_level}, {"checksum", false}}}};
    return ZarrJson::array({std::move(bytes), std::move(packing)});
}

std::vector<ZarrArray> positions_of(const grid::GridSpec& spec, const netcdf::MapNames& names) {
    if (spec.in_degrees()) return {};
    ZarrArray latitude{
        .name = "lat",
        .number = ZarrNumber::float64,
        .dimensions = {names.y, names.x},
        .shape = {static_cast<std::size_t>(spec.ny), static_cast<std::size_t>(spec.nx)},
        .chunk = {chunk_side, chunk_side},
        .fill = "NaN",
        .attributes = json_of(netcdf::latitude_attributes())};
    ZarrArray longitude = latitude;
    longitude.name = "lon";
    longitude.attributes = json_of(netcdf::longitude_attributes());
    return {std::move(latitude), std::move(longitude)};
}

}  // namespace

const ZarrArray* ZarrGroup::find(std::string_view name) const {
    const auto found = std::ranges::find(arrays, name, &ZarrArray::name);
    return found == arrays.end() ? nullptr : &*found;
}

int chunk_levels(const grid::GridSpec& spec) {
    return std::min(spec.nz(), chunk_side);
}

ZarrJson json_of(const netcdf::CfAttributes& attributes) {
    ZarrJson json = ZarrJson::object();
    for (const auto& [name, value] : attributes)
        std::visit([&json, key = name](const auto& held) { json[key] = held; }, value);
    return json;
}

ZarrArray axis(std::string name, std::size_t size, std::size_t chunk,
               const netcdf::CfAttributes& attributes) {
    return {.name = name,
            .number = ZarrNumber::float64,
            .dimensions = {name},
            .shape = {size},
            .chunk = {chunk},
            .fill = "NaN",
            .attributes = json_of(attributes)};
}

ZarrArray array_of_cells(const grid::GridSpec& spec, std::size_t times) {
    const netcdf::MapNames names = netcdf::map_names(spec);
    return {.name = {},
            .number = ZarrNumber::float32,
            .dimensions = {"time", "z", names.y, names.x},
            .shape = {times, spec.levels_m.size(), static_cast<std::size_t>(spec.ny),
                      static_cast<std::size_t>(spec.nx)},
            .chunk = {1, static_cast<std::size_t>(chunk_levels(spec)), chunk_side, chunk_side},
            .fill = "NaN"};
}

void place_on_map(ZarrArray& array, const grid::GridSpec& spec) {
    array.attributes.update(json_of(netcdf::reference_to_map(spec)));
    array.version2_attributes["_CRS"] = {{"wkt", netcdf::well_known_text(spec)}};
}

void add_flags(ZarrArray& array, Flags flags) {
    array.number = ZarrNumber::int8;
    array.fill = flags.unavailable;
    flags.values.push_back(flags.unavailable);
    array.attributes["flag_values"] = flags.values;
    array.attributes["flag_meanings"] = flags.meanings + "unavailable";
    array.attributes["fill_value_comment"] = flags.comment;
}

std::vector<ZarrArray> map_arrays(const grid::GridSpec& spec) {
    const netcdf::MapNames names = netcdf::map_names(spec);
    const auto rows = static_cast<std::size_t>(spec.ny);
    const auto columns = static_cast<std::size_t>(spec.nx);
    std::vector<ZarrArray> arrays = {
        axis(names.y, rows, rows, netcdf::row_attributes(spec)),
        axis(names.x, columns, columns, netcdf::column_attributes(spec))};
    for (ZarrArray& position : positions_of(spec, names))
        arrays.push_back(std::move(position));
    arrays.push_back({.name = netcdf::mapping_name(spec.projection),
                      .number = ZarrNumber::int32,
                      .dimensions = {},
                      .shape = {},
                      .chunk = {},
                      .fill = -1,
                      .attributes = json_of(netcdf::mapping_attributes(spec))});
    return arrays;
}

ZarrJson zarray_of(const ZarrArray& array) {
    return {{"zarr_format", 2},
            {"shape", array.shape},
            {"chunks", array.chunk},
            {"dtype", names_of(array.number).version2},
            {"compressor", {{"id", "gzip"}, {"level", gzip_level}}},
            {"fill_value", array.fill},
            {"order", "C"},
            {"filters", nullptr}};
}

ZarrJson zattrs_of(const ZarrArray& array) {
    ZarrJson attributes = array.attributes;
    attributes.update(array.version2_attributes);
    attributes["_ARRAY_DIMENSIONS"] = array.dimensions;
    return attributes;
}

ZarrJson zmetadata_of(const ZarrGroup& group) {
    ZarrJson metadata = {{".zgroup", {{"zarr_format", 2}}}, {".zattrs", group.attributes}};
    for (const ZarrArray& array : group.arrays) {
        metadata[array.name + "/.zarray"] = zarray_of(array);
        metadata[array.name + "/.zattrs"] = zattrs_of(array);
    }
    return {{"zarr_consolidated_format", 1}, {"metadata", std::move(metadata)}};
}

ZarrJson zarr3_of(const ZarrArray& array) {
    return {
        {"zarr_format", 3},
        {"node_type", "array"},
        {"shape", array.shape},
        {"data_type", names_of(array.number).version3},
        {"chunk_grid", {{"name", "regular"}, {"configuration", {{"chunk_shape", array.chunk}}}}},
        {"chunk_key_encoding", {{"name", "default"}, {"configuration", {{"separator", "/"}}}}},
        {"fill_value", array.fill},
        {"codecs", codecs_of(array)},
        {"attributes", array.attributes},
        {"dimension_names", array.dimensions}};
}

ZarrJson zarr3_of(const ZarrGroup& group) {
    ZarrJson arrays = ZarrJson::object();
    for (const ZarrArray& array : group.arrays)
        arrays[array.name] = zarr3_of(array);
    return {{"zarr_format", 3},
            {"node_type", "group"},
            {"attributes", group.attributes},
            {"consolidated_metadata",
             {{"kind", "inline"}, {"must_understand", false}, {"metadata", std::move(arrays)}}}};
}

std::string text_of(const ZarrJson& document) {
    return document.dump(1, ' ', false, ZarrJson::error_handler_t::replace) + "\n";
}

}  // namespace stormcellar::zarr
