// Writes netCDF: a map as a variable (time, y, x) in the grid's own projection, with the states of
// its columns. A cell is a column of the grid, so nothing is resampled.
#include <cmath>
#include <utility>

#include "export/map_netcdf.h"
#include "render/still/map_attributes.h"
#include "render/still/map_raster.h"
#include "render/still/still_format.h"

namespace stormcellar::render {

Result<std::vector<std::byte>> encode_netcdf(const StillMap& map, const StillOptions& options) {
    const auto field = still_field(map, options.threads);
    if (!field) return pass_on(field);
    std::vector<float> values = field->values;
    std::vector<signed char> states;
    for (std::size_t place = 0; place < values.size(); ++place) {
        if (field->status[place] != grid::CellStatus::value) values[place] = std::nanf("");
        states.push_back(static_cast<signed char>(state_of(*field, place)));
    }
    std::vector<netcdf::MapFlag> flags;
    for (const StateClass& state : state_classes(map.scene.moment)) {
        if (may_have(map.scene.product, state))
            flags.push_back({static_cast<signed char>(state.code), state_word(state)});
    }
    return netcdf::map_netcdf_bytes({.spec = *map.view.spec,
                                     .time = map.facts.time,
                                     .since = map.facts.since,
                                     .name = map_variable(map.scene.product),
                                     .attributes = map_attributes(map.scene, map.facts),
                                     .values = values,
                                     .states = states,
                                     .flags = std::move(flags),
                                     .state_attributes = map_state_attributes(map.scene),
                                     .file_attributes = map_file_attributes(map, options)});
}

}  // namespace stormcellar::render
