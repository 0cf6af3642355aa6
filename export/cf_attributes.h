// export/cf_attributes.h -- the names and attributes of the variables of a grid, in the terms of
// CF; internal.
//
// This file is the only source of these names and attributes. NetCDF files (export/grid_netcdf.h)
// and all other descriptions of a grid in terms of CF use it.
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

using CfValue = std::variant<std::string, double, std::vector<double>>;
using CfAttributes = std::vector<std::pair<std::string, CfValue>>;

// The names of the two dimensions of a map, and of their coordinates.
struct MapNames {
    const char* y;
    const char* x;
};
[[nodiscard]] MapNames map_names(const grid::GridSpec& spec);
// Returns azimuthal_equidistant, latitude_longitude or lambert_conformal_conic.
[[nodiscard]] const char* mapping_name(grid::Projection projection);

[[nodiscard]] CfAttributes time_attributes(std::string_view long_name);
[[nodiscard]] CfAttributes height_attributes();
[[nodiscard]] CfAttributes row_attributes(const grid::GridSpec& spec);
[[nodiscard]] CfAttributes column_attributes(const grid::GridSpec& spec);
// Return the attributes of the variables lat and lon of a map in meters, whose dimensions are y and
// x.
[[nodiscard]] CfAttributes latitude_attributes();
[[nodiscard]] CfAttributes longitude_attributes();
[[nodiscard]] CfAttributes mapping_attributes(const grid::GridSpec& spec);
// Returns the mapping as well-known text (WKT 1, as GDAL writes it).
[[nodiscard]] std::string well_known_text(const grid::GridSpec& spec);
// Returns the attributes by which a field refers to the map.
[[nodiscard]] CfAttributes reference_to_map(const grid::GridSpec& spec);
// Returns the attributes of a field. `method` comes from the provenance of the grid.
[[nodiscard]] CfAttributes field_attributes(level2::Moment moment, std::string_view method);

// Returns long_name, standard_name and comment of the states; the flags are separate.
[[nodiscard]] CfAttributes status_attributes(level2::Moment moment);

// Return the places of rows and columns: meters, or degrees of latitude and continuous longitude.
[[nodiscard]] std::vector<double> row_places(const grid::GridSpec& spec);
[[nodiscard]] std::vector<double> column_places(const grid::GridSpec& spec);

}  // namespace stormcellar::netcdf
