// export/grid_coordinates.h -- writes the places of the cells of a grid file, in the terms of CF;
// internal to export.
//
// A grid in latitude and longitude has the dimensions lat and lon. They are also the coordinates,
// so that readers find these without asking for attributes. A grid with another projection has the
// dimensions and coordinates y and x in meters, and the variables lat and lon give the place of
// each column. Longitudes are within 180 degrees of the center's longitude, so they continue across
// the antimeridian (179.5, 180.5). The variable of the projection has the name of its CF grid
// mapping (CF-1.8, appendix F).
//
// Threads   Hold library_mutex() (export/netcdf_builder.h) during all calls.
#pragma once

#include "export/cf_attributes.h"
#include "export/netcdf_builder.h"
#include "stormcellar/grid/grid_spec.h"

namespace stormcellar::netcdf {

struct MapDimensions {
    int y = 0, x = 0;
};

void write_attributes(NetcdfBuilder& file, int variable, const CfAttributes& attributes);
void write_mapping(NetcdfBuilder& file, const grid::GridSpec& spec);
void write_map_axes(NetcdfBuilder& file, const grid::GridSpec& spec, const MapDimensions& size);
// Writes lat and lon of each column. Writes nothing if the dimensions are lat and lon already.
void write_positions(NetcdfBuilder& file, const grid::GridSpec& spec, const MapDimensions& size,
                     int deflate_level);
// Adds the attributes that link a field to the map on which its cells are.
void refer_to_map(NetcdfBuilder& file, int variable, const grid::GridSpec& spec);

}  // namespace stormcellar::netcdf
