// export/grid_coordinates.h -- where the cells of a grid file are, as CF says it; internal to
// export.
//
// Dimensions are y and x whatever the projection. Of a plane projection the coordinates y and x are
// metres and lat and lon give each column's place; of latitude_longitude y and x are themselves
// latitude and longitude. Longitudes are within 180 degrees of the centre's, so they go on across
// the antimeridian (179.5, 180.5). The mapping variable bears the name of its CF grid mapping
// (CF-1.8, appendix F).
#pragma once

#include "export/netcdf_builder.h"
#include "stormcellar/grid/grid_spec.h"

namespace stormcellar::netcdf {

struct MapDimensions {
    int y = 0, x = 0;
};

// azimuthal_equidistant, latitude_longitude or lambert_conformal_conic.
[[nodiscard]] const char* mapping_name(grid::Projection projection);

void write_mapping(NetcdfBuilder& file, const grid::GridSpec& spec);
void write_map_axes(NetcdfBuilder& file, const grid::GridSpec& spec, const MapDimensions& size);
// lat and lon of each column; nothing where y and x say it already.
void write_positions(NetcdfBuilder& file, const grid::GridSpec& spec, const MapDimensions& size,
                     int deflate_level);
// What a field on this map says of it.
void refer_to_map(NetcdfBuilder& file, int variable, const grid::GridSpec& spec);

}  // namespace stormcellar::netcdf
