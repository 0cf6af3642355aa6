// web/data/zarr/zarr_layout.h -- describes a domain and moment as a group of Zarr arrays over time.
//
// Arrays, chunks and documents are as in Zarr stores on disk (export/zarr_layout.h).
//
// The group of a 2D product, such as mesh or composite.VEL, has the arrays of its values and states
// (time, y, x), with the attributes that its netCDF file has (render/still/map_attributes.h).
//
// The group of a moment has the arrays MOMENT and status (time, z, y, x), the coordinates time, z,
// y and x, the positions lat and lon (y, x), and the variable of the CF grid mapping. A grid in
// latitude and longitude has the dimensions lat and lon instead of y and x, and no positions.
//
// Threads   Pure functions.
// Errors    None.
#pragma once

#include <cstddef>
#include <string_view>

#include "export/zarr_layout.h"
#include "stormcellar/cache/grid_file.h"
#include "web/data/pictures/map_product.h"

namespace stormcellar::web {

using zarr::ZarrArray;
using zarr::ZarrGroup;
using zarr::ZarrJson;
using zarr::ZarrNumber;
using zarr::ZarrVersion;

inline constexpr std::size_t times_of_a_chunk = 4096;

// Return the group for grids at `times` times: for the moment of the grids, or for a product of the
// grids. The grids have the cells of `newest`.
[[nodiscard]] ZarrGroup zarr_group(std::string_view domain, const cache::GridDescription& newest,
                                   std::size_t times);
[[nodiscard]] ZarrGroup zarr_group_of_map(std::string_view domain,
                                          const cache::GridDescription& newest, std::size_t times,
                                          const MapStyle& style);

}  // namespace stormcellar::web
