#include "export/grid_coordinates.h"

#include <vector>

#include <netcdf.h>

#include "stormcellar/grid/projection.h"

namespace stormcellar::netcdf {
namespace {

void write_axis(NetcdfBuilder& file, int dimension, const char* name,
                const CfAttributes& attributes, const std::vector<double>& places) {
    const int variable = file.variable(name, NC_DOUBLE, {dimension});
    write_attributes(file, variable, attributes);
    file.write(variable, std::span(places));
}

}  // namespace

void write_attributes(NetcdfBuilder& file, int variable, const CfAttributes& attributes) {
    for (const auto& [name, value] : attributes) {
        if (const auto* text = std::get_if<std::string>(&value)) {
            file.text(variable, name.c_str(), *text);
        } else if (const auto* number = std::get_if<double>(&value)) {
            file.number(variable, name.c_str(), *number);
        } else if (const auto* count = std::get_if<int>(&value)) {
            file.number(variable, name.c_str(), *count);
        } else {
            file.numbers(variable, name.c_str(), std::get<std::vector<double>>(value));
        }
    }
}

void write_mapping(NetcdfBuilder& file, const grid::GridSpec& spec) {
    const int mapping = file.variable(mapping_name(spec.projection), NC_INT, {});
    write_attributes(file, mapping, mapping_attributes(spec));
}

void write_map_axes(NetcdfBuilder& file, const grid::GridSpec& spec, const MapDimensions& size) {
    const MapNames names = map_names(spec);
    write_axis(file, size.y, names.y, row_attributes(spec), row_places(spec));
    write_axis(file, size.x, names.x, column_attributes(spec), column_places(spec));
}

void write_positions(NetcdfBuilder& file, const grid::GridSpec& spec, const MapDimensions& size,
                     int deflate_level) {
    if (spec.in_degrees()) return;
    const grid::GridProjection projection(spec);
    std::vector<double> latitudes_deg;
    std::vector<double> longitudes_deg;
    latitudes_deg.reserve(spec.column_count());
    longitudes_deg.reserve(spec.column_count());
    for (int iy = 0; iy < spec.ny; ++iy) {
        for (int ix = 0; ix < spec.nx; ++ix) {
            const grid::GeoPoint point = projection.to_geo({1.0 * ix, 1.0 * iy});
            latitudes_deg.push_back(point.latitude_deg);
            longitudes_deg.push_back(projection.continuous_longitude_deg(point.longitude_deg));
        }
    }
    const auto write = [&](const char* name, const CfAttributes& attributes,
                           const std::vector<double>& values) {
        const int variable = file.variable(name, NC_DOUBLE, {size.y, size.x});
        file.deflate(variable, deflate_level);
        write_attributes(file, variable, attributes);
        file.write(variable, std::span(values));
    };
    write("lat", latitude_attributes(), latitudes_deg);
    write("lon", longitude_attributes(), longitudes_deg);
}

void refer_to_map(NetcdfBuilder& file, int variable, const grid::GridSpec& spec) {
    write_attributes(file, variable, reference_to_map(spec));
}

}  // namespace stormcellar::netcdf
