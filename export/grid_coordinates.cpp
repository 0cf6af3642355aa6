#include "export/grid_coordinates.h"

#include <vector>

#include <netcdf.h>

#include "stormcellar/grid/beam_geometry.h"
#include "stormcellar/grid/projection.h"

namespace stormcellar::netcdf {
namespace {

// How CF names a projection and the longitude of its origin (CF-1.8, appendix F).
struct MappingNames {
    const char* mapping;
    const char* origin_longitude;
};
MappingNames names_of(grid::Projection projection) {
    switch (projection) {
        case grid::Projection::azimuthal_equidistant:
            return {"azimuthal_equidistant", "longitude_of_projection_origin"};
        case grid::Projection::latitude_longitude:
            return {"latitude_longitude", ""};
        case grid::Projection::lambert_conformal:
            return {"lambert_conformal_conic", "longitude_of_central_meridian"};
    }
    return {"", ""};
}

struct Axis {
    const char* name;
    const char* standard_name;
    const char* units;
    const char* letter;
    const char* long_name;
};

void write_axis(NetcdfBuilder& file, int dimension, const Axis& axis,
                const std::vector<double>& places) {
    const int variable = file.variable(axis.name, NC_DOUBLE, {dimension});
    file.text(variable, "standard_name", axis.standard_name);
    file.text(variable, "units", axis.units);
    file.text(variable, "axis", axis.letter);
    file.text(variable, "long_name", axis.long_name);
    file.write(variable, std::span(places));
}

void write_origin(NetcdfBuilder& file, int mapping, const grid::GridSpec& spec) {
    file.number(mapping, "latitude_of_projection_origin", spec.center_latitude_deg);
    file.number(mapping, names_of(spec.projection).origin_longitude, spec.center_longitude_deg);
    file.number(mapping, "false_easting", 0.0);
    file.number(mapping, "false_northing", 0.0);
    if (!grid::facts_of(spec.projection).takes_parallels) return;
    const auto [first_deg, second_deg] = spec.parallels_deg;
    if (first_deg == second_deg) {
        file.number(mapping, "standard_parallel", first_deg);
    } else {
        file.numbers(mapping, "standard_parallel", spec.parallels_deg);
    }
}

}  // namespace

MapNames map_names(const grid::GridSpec& spec) {
    return spec.in_degrees() ? MapNames{"lat", "lon"} : MapNames{"y", "x"};
}

const char* mapping_name(grid::Projection projection) {
    return names_of(projection).mapping;
}

void write_mapping(NetcdfBuilder& file, const grid::GridSpec& spec) {
    const char* name = mapping_name(spec.projection);
    const int mapping = file.variable(name, NC_INT, {});
    file.text(mapping, "grid_mapping_name", name);
    if (!spec.in_degrees()) write_origin(file, mapping, spec);
    file.number(mapping, "semi_major_axis", grid::wgs84_semi_major_m);
    file.number(mapping, "inverse_flattening", 1 / grid::wgs84_flattening);
    file.number(mapping, "longitude_of_prime_meridian", 0.0);
    file.text(mapping, "comment",
              "WGS84; heights above mean sea level are used as heights above the ellipsoid (about "
              "1 m at 230 km)");
}

void write_map_axes(NetcdfBuilder& file, const grid::GridSpec& spec, const MapDimensions& size) {
    const grid::GridProjection projection(spec);
    const bool degrees = spec.in_degrees();
    std::vector<double> rows;
    std::vector<double> columns;
    rows.reserve(static_cast<std::size_t>(spec.ny));
    columns.reserve(static_cast<std::size_t>(spec.nx));
    for (int iy = 0; iy < spec.ny; ++iy)
        rows.push_back(degrees ? projection.row_latitude_deg(iy) : spec.y_m(iy));
    for (int ix = 0; ix < spec.nx; ++ix)
        columns.push_back(degrees ? projection.column_longitude_deg(ix) : spec.x_m(ix));
    const MapNames names = map_names(spec);
    if (degrees) {
        write_axis(file, size.y, {names.y, "latitude", "degrees_north", "Y", "latitude"}, rows);
        write_axis(file, size.x, {names.x, "longitude", "degrees_east", "X", "longitude"}, columns);
        return;
    }
    write_axis(file, size.y,
               {names.y, "projection_y_coordinate", "m", "Y", "distance north of the centre"},
               rows);
    write_axis(file, size.x,
               {names.x, "projection_x_coordinate", "m", "X", "distance east of the centre"},
               columns);
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
    const auto write = [&](const char* name, const char* standard_name, const char* units,
                           const std::vector<double>& values) {
        const int variable = file.variable(name, NC_DOUBLE, {size.y, size.x});
        file.deflate(variable, deflate_level);
        file.text(variable, "standard_name", standard_name);
        file.text(variable, "units", units);
        file.write(variable, std::span(values));
    };
    write("lat", "latitude", "degrees_north", latitudes_deg);
    write("lon", "longitude", "degrees_east", longitudes_deg);
}

void refer_to_map(NetcdfBuilder& file, int variable, const grid::GridSpec& spec) {
    if (!spec.in_degrees()) file.text(variable, "coordinates", "lat lon");
    file.text(variable, "grid_mapping", mapping_name(spec.projection));
}

}  // namespace stormcellar::netcdf
