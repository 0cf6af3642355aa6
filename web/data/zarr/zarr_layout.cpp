#include "web/data/zarr/zarr_layout.h"

#include <algorithm>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "export/cf_attributes.h"
#include "render/still/map_attributes.h"
#include "stormcellar/level2/moment.h"
#include "stormcellar/retrieve/derived_moments.h"
#include "web/data/grids/compressed.h"
#include "web/data/zarr/zarr_cells.h"

namespace stormcellar::web {
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
        case ZarrNumber::int32:
            return {"<i4", "int32"};
    }
    return {"", ""};
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

// The states of an array, and the flag for grids that are gone.
struct Flags {
    std::vector<int> values = {};
    std::string meanings = {};  // each followed by a blank
    std::int8_t unavailable = 0;
};

// Completes a pair of arrays: `values` has its name, shape, chunks and attributes.
std::vector<ZarrArray> with_states(ZarrArray values, const grid::GridSpec& spec,
                                   const netcdf::CfAttributes& of_states, Flags flags) {
    values.number = ZarrNumber::float32;
    values.fill = "NaN";
    values.attributes.update(json_of(netcdf::reference_to_map(spec)));
    values.attributes["ancillary_variables"] = "status";
    values.version2_attributes["_CRS"] = {{"wkt", netcdf::well_known_text(spec)}};
    ZarrArray states = values;
    states.name = "status";
    states.number = ZarrNumber::int8;
    states.fill = flags.unavailable;
    states.attributes = json_of(of_states);
    states.attributes.update(json_of(netcdf::reference_to_map(spec)));
    flags.values.push_back(flags.unavailable);
    states.attributes["flag_values"] = flags.values;
    states.attributes["flag_meanings"] = flags.meanings + "unavailable";
    states.attributes["fill_value_comment"] =
        "unavailable: the grid of this time was evicted, or could not be read; nothing is known of "
        "the cell";
    return {std::move(values), std::move(states)};
}

std::vector<ZarrArray> fields_of(const cache::GridDescription& newest, std::size_t times,
                                 const netcdf::MapNames& names) {
    const grid::GridSpec& spec = newest.spec;
    ZarrArray values{
        .name = std::string(level2::moment_name(newest.moment)),
        .dimensions = {"time", "z", names.y, names.x},
        .shape = {times, spec.levels_m.size(), static_cast<std::size_t>(spec.ny),
                  static_cast<std::size_t>(spec.nx)},
        .chunk = {1, static_cast<std::size_t>(chunk_levels(spec)), chunk_side, chunk_side},
        .attributes = json_of(netcdf::field_attributes(newest.moment, newest.provenance.method))};
    Flags flags{.unavailable = status_unavailable};
    for (const grid::CellStatus state : grid::states_of(newest.moment)) {
        flags.values.push_back(static_cast<int>(state));
        flags.meanings += std::string(grid::cell_status_name(state)) + " ";
    }
    return with_states(std::move(values), spec, netcdf::status_attributes(newest.moment),
                       std::move(flags));
}

std::vector<ZarrArray> map_fields_of(const cache::GridDescription& newest, std::size_t times,
                                     const netcdf::MapNames& names, const render::Scene& scene) {
    const grid::GridSpec& spec = newest.spec;
    render::FrameFacts facts;
    // The share that was left out differs from grid to grid.
    facts.quality = retrieve::quality_in_notes(newest.provenance.notes);
    facts.quality = facts.quality.substr(0, facts.quality.find(';'));
    ZarrArray values{
        .name = render::map_variable(scene.product),
        .dimensions = {"time", names.y, names.x},
        .shape = {times, static_cast<std::size_t>(spec.ny), static_cast<std::size_t>(spec.nx)},
        .chunk = {1, chunk_side, chunk_side},
        .attributes = json_of(render::map_attributes(scene, facts))};
    Flags flags{.unavailable = map_status_unavailable};
    for (const render::StateClass& state : render::state_classes(scene.moment)) {
        if (!render::may_have(scene.product, state)) continue;
        flags.values.push_back(state.code);
        flags.meanings += render::state_word(state) + " ";
    }
    return with_states(std::move(values), spec, render::map_state_attributes(scene),
                       std::move(flags));
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

// Adds the coordinates, except heights, and the attributes to the fields of a group.
ZarrGroup group_about(std::vector<ZarrArray> fields, std::string_view domain,
                      const cache::GridDescription& newest, std::size_t times,
                      std::string_view title) {
    const grid::GridSpec& spec = newest.spec;
    const netcdf::MapNames names = netcdf::map_names(spec);
    ZarrGroup group;
    group.arrays = std::move(fields);
    group.arrays.push_back(
        axis("time", times, times_of_a_chunk, netcdf::time_attributes("time of the grid")));
    group.arrays.push_back(axis(names.y, static_cast<std::size_t>(spec.ny),
                                static_cast<std::size_t>(spec.ny), netcdf::row_attributes(spec)));
    group.arrays.push_back(axis(names.x, static_cast<std::size_t>(spec.nx),
                                static_cast<std::size_t>(spec.nx),
                                netcdf::column_attributes(spec)));
    for (ZarrArray& position : positions_of(spec, names))
        group.arrays.push_back(std::move(position));
    group.arrays.push_back({.name = netcdf::mapping_name(spec.projection),
                            .number = ZarrNumber::int32,
                            .dimensions = {},
                            .shape = {},
                            .chunk = {},
                            .fill = -1,
                            .attributes = json_of(netcdf::mapping_attributes(spec))});
    group.attributes = {
        {"Conventions", "CF-1.8"},
        {"title", fmt::format("{} of {}, gridded", title, domain)},
        {"source", "weather radar Level II volumes"},
        {"domain", domain},
        {"comment",
         "A time keeps its index for good, so times need not rise: sort by them. Grids that are "
         "gone have no value and the status unavailable."},
        {"provenance",
         fmt::format("/api/v1/grids/{}/{}/TIME", domain, level2::moment_name(newest.moment))}};
    return group;
}

}  // namespace

const ZarrArray* ZarrGroup::find(std::string_view name) const {
    const auto found = std::ranges::find(arrays, name, &ZarrArray::name);
    return found == arrays.end() ? nullptr : &*found;
}

ZarrGroup zarr_group(std::string_view domain, const cache::GridDescription& newest,
                     std::size_t times) {
    const grid::GridSpec& spec = newest.spec;
    ZarrGroup group = group_about(fields_of(newest, times, netcdf::map_names(spec)), domain, newest,
                                  times, level2::moment_name(newest.moment));
    group.arrays.push_back(
        axis("z", spec.levels_m.size(), spec.levels_m.size(), netcdf::height_attributes()));
    return group;
}

ZarrGroup zarr_group_of_map(std::string_view domain, const cache::GridDescription& newest,
                            std::size_t times, const MapStyle& style) {
    return group_about(map_fields_of(newest, times, netcdf::map_names(newest.spec), style.scene),
                       domain, newest, times, style.layer.name());
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
        {"codecs",
         ZarrJson::array({{{"name", "bytes"}, {"configuration", {{"endian", "little"}}}},
                          {{"name", "gzip"}, {"configuration", {{"level", gzip_level}}}}})},
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

}  // namespace stormcellar::web
