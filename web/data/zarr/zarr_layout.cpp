#include "web/data/zarr/zarr_layout.h"

#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "export/cf_attributes.h"
#include "render/still/map_attributes.h"
#include "stormcellar/level2/moment.h"
#include "stormcellar/retrieve/derived_moments.h"
#include "web/data/zarr/zarr_cells.h"

namespace stormcellar::web {
namespace {

constexpr std::string_view when_unavailable =
    "unavailable: the grid of this time was evicted, or could not be read; nothing is known of the "
    "cell";

// Completes a pair of arrays: `values` has its name, shape, chunks and attributes.
std::vector<ZarrArray> with_states(ZarrArray values, const grid::GridSpec& spec,
                                   const netcdf::CfAttributes& of_states, zarr::Flags flags) {
    zarr::place_on_map(values, spec);
    values.attributes["ancillary_variables"] = "status";
    ZarrArray states = values;
    states.name = "status";
    states.attributes = zarr::json_of(of_states);
    zarr::place_on_map(states, spec);
    flags.comment = when_unavailable;
    zarr::add_flags(states, std::move(flags));
    return {std::move(values), std::move(states)};
}

std::vector<ZarrArray> fields_of(const cache::GridDescription& newest, std::size_t times) {
    const grid::GridSpec& spec = newest.spec;
    ZarrArray values = zarr::array_of_cells(spec, times);
    values.name = level2::moment_name(newest.moment);
    values.attributes =
        zarr::json_of(netcdf::field_attributes(newest.moment, newest.provenance.method));
    zarr::Flags flags;
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
        .number = ZarrNumber::float32,
        .dimensions = {"time", names.y, names.x},
        .shape = {times, static_cast<std::size_t>(spec.ny), static_cast<std::size_t>(spec.nx)},
        .chunk = {1, chunk_side, chunk_side},
        .fill = "NaN",
        .attributes = zarr::json_of(render::map_attributes(scene, facts))};
    zarr::Flags flags{.unavailable = map_status_unavailable, .comment = {}};
    for (const render::StateClass& state : render::state_classes(scene.moment)) {
        if (!render::may_have(scene.product, state)) continue;
        flags.values.push_back(state.code);
        flags.meanings += render::state_word(state) + " ";
    }
    return with_states(std::move(values), spec, render::map_state_attributes(scene),
                       std::move(flags));
}

// Adds the coordinates, except heights, and the attributes to the fields of a group.
ZarrGroup group_about(std::vector<ZarrArray> fields, std::string_view domain,
                      const cache::GridDescription& newest, std::size_t times,
                      std::string_view title) {
    const grid::GridSpec& spec = newest.spec;
    ZarrGroup group;
    group.arrays = std::move(fields);
    group.arrays.push_back(
        zarr::axis("time", times, times_of_a_chunk, netcdf::time_attributes("time of the grid")));
    for (ZarrArray& array : zarr::map_arrays(spec))
        group.arrays.push_back(std::move(array));
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

ZarrGroup zarr_group(std::string_view domain, const cache::GridDescription& newest,
                     std::size_t times) {
    const grid::GridSpec& spec = newest.spec;
    ZarrGroup group = group_about(fields_of(newest, times), domain, newest, times,
                                  level2::moment_name(newest.moment));
    group.arrays.push_back(
        zarr::axis("z", spec.levels_m.size(), spec.levels_m.size(), netcdf::height_attributes()));
    return group;
}

ZarrGroup zarr_group_of_map(std::string_view domain, const cache::GridDescription& newest,
                            std::size_t times, const MapStyle& style) {
    return group_about(map_fields_of(newest, times, netcdf::map_names(newest.spec), style.scene),
                       domain, newest, times, style.layer.name());
}

}  // namespace stormcellar::web
