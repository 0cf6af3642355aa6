// export/cf_attributes.h -- the names and attributes that CF gives to the variables of a grid;
// internal.
//
// These names and attributes have no other source: NetCDF files (export/grid_netcdf.h) and all
// other descriptions of a grid in the terms of CF take them from here.
//
// Units     CF units, named in the attributes.
// Threads   Pure functions.
// Errors    None; specs must be valid.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "stormcellar/grid/grid_spec.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::netcdf {

using CfValue = std::variant<std::string, double, int, std::vector<double>>;
using CfAttributes = std::vector<std::pair<std::string, CfValue>>;

// The names of the two dimensions of a map, and of their coordinates.
struct MapNames {
    const char* y;
    const char* x;
};
[[nodiscard]] MapNames map_names(const grid::GridSpec& spec);
// Returns the CF name of the projection: azimuthal_equidistant, latitude_longitude or
// lambert_conformal_conic.
[[nodiscard]] const char* mapping_name(grid::Projection projection);

[[nodiscard]] CfAttributes time_attributes(std::string_view long_name);
[[nodiscard]] CfAttributes height_attributes();
[[nodiscard]] CfAttributes row_attributes(const grid::GridSpec& spec);
[[nodiscard]] CfAttributes column_attributes(const grid::GridSpec& spec);
// Return the attributes of the variables lat and lon. Only a map in meters, whose dimensions are y
// and x, has these variables.
[[nodiscard]] CfAttributes latitude_attributes();
[[nodiscard]] CfAttributes longitude_attributes();
[[nodiscard]] CfAttributes mapping_attributes(const grid::GridSpec& spec);
// Returns the projection of the grid as well-known text (WKT 1, as GDAL writes it).
[[nodiscard]] std::string well_known_text(const grid::GridSpec& spec);
// Returns the attributes that link a field to the map on which its cells are.
[[nodiscard]] CfAttributes reference_to_map(const grid::GridSpec& spec);
// Returns the attributes of a field. `method` is from the provenance of the grid.
[[nodiscard]] CfAttributes field_attributes(level2::Moment moment, std::string_view method);

// Returns long_name, standard_name and comment of the variable of states. The flags are separate.
[[nodiscard]] CfAttributes status_attributes(level2::Moment moment);

// Return the coordinates of rows and columns: meters, or degrees of latitude and of longitude.
// Longitudes continue across the antimeridian.
[[nodiscard]] std::vector<double> row_places(const grid::GridSpec& spec);
[[nodiscard]] std::vector<double> column_places(const grid::GridSpec& spec);

}  // namespace stormcellar::netcdf
