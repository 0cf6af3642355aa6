#include "export/map_netcdf.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include <fmt/ranges.h>
#include <netcdf.h>

#include "export/grid_coordinates.h"
#include "export/netcdf_builder.h"

namespace stormcellar::netcdf {
namespace {

constexpr int map_deflate_level = 1;
constexpr std::size_t largest_map_chunk = 512;

double unix_seconds(UtcTime time) {
    return std::chrono::duration<double>(time.time_since_epoch()).count();
}

// Writes the time first, because this gives the unlimited dimension its one element.
void write_time(NetcdfBuilder& file, const NetcdfMap& map, int time_dimension) {
    const int time = file.variable("time", NC_DOUBLE, {time_dimension});
    write_attributes(file, time, time_attributes(map.since ? "end of the span" : "time"));
    file.chunks(time, {1});
    file.write_first(time, unix_seconds(map.time));
    if (!map.since) return;
    file.text(time, "bounds", "time_bnds");
    const int bounds =
        file.variable("time_bnds", NC_DOUBLE, {time_dimension, file.dimension("nv", 2)});
    file.chunks(bounds, {1, 2});
    const std::array<double, 2> span{unix_seconds(*map.since), unix_seconds(map.time)};
    file.write(bounds, std::span<const double>(span));
}

struct MapVariable {
    const char* name;
    int type;
};

int define_on_map(NetcdfBuilder& file, const MapVariable& of, int time, const MapDimensions& size,
                  const grid::GridSpec& spec) {
    const int variable = file.variable(of.name, of.type, {time, size.y, size.x});
    file.chunks(variable, {1, std::min<std::size_t>(spec.ny, largest_map_chunk),
                           std::min<std::size_t>(spec.nx, largest_map_chunk)});
    file.deflate(variable, map_deflate_level);
    refer_to_map(file, variable, spec);
    return variable;
}

void write_values(NetcdfBuilder& file, const NetcdfMap& map, int time, const MapDimensions& size) {
    constexpr float fill = NC_FILL_FLOAT;
    const int variable = define_on_map(file, {map.name.c_str(), NC_FLOAT}, time, size, map.spec);
    file.fill_value(variable, fill);
    write_attributes(file, variable, map.attributes);
    file.text(variable, "ancillary_variables", "status");
    std::vector<float> values(map.values.begin(), map.values.end());
    std::ranges::replace_if(
        values, [](float value) { return std::isnan(value); }, fill);
    file.write(variable, std::span<const float>(values));
}

void write_states(NetcdfBuilder& file, const NetcdfMap& map, int time, const MapDimensions& size) {
    const int variable = define_on_map(file, {"status", NC_BYTE}, time, size, map.spec);
    write_attributes(file, variable, map.state_attributes);
    std::vector<signed char> numbers;
    std::vector<std::string> meanings;
    for (const MapFlag& flag : map.flags) {
        numbers.push_back(flag.number);
        meanings.push_back(flag.meaning);
    }
    file.bytes(variable, "flag_values", numbers);
    file.text(variable, "flag_meanings", fmt::format("{}", fmt::join(meanings, " ")));
    file.write(variable, map.states);
}

}  // namespace

Result<std::vector<std::byte>> map_netcdf_bytes(const NetcdfMap& map) {
    if (auto valid = grid::validate(map.spec); !valid) return pass_on(valid);
    const std::size_t columns = map.spec.column_count();
    if (map.values.size() != columns || map.states.size() != columns) {
        return fail(ErrorCode::bad_argument, "the map has {} values and {} states for {} columns",
                    map.values.size(), map.states.size(), columns);
    }
    const MutexLock lock(library_mutex());
    NetcdfBuilder file;
    const MapNames names = map_names(map.spec);
    const int time = file.dimension("time", 0);
    const MapDimensions size{file.dimension(names.y, static_cast<std::size_t>(map.spec.ny)),
                             file.dimension(names.x, static_cast<std::size_t>(map.spec.nx))};
    file.text(NetcdfBuilder::file, "Conventions", "CF-1.8");
    write_attributes(file, NetcdfBuilder::file, map.file_attributes);
    write_time(file, map, time);
    write_map_axes(file, map.spec, size);
    write_mapping(file, map.spec);
    write_positions(file, map.spec, size, map_deflate_level);
    write_values(file, map, time, size);
    write_states(file, map, time, size);
    return file.finish();
}

}  // namespace stormcellar::netcdf
