// web/data/zarr/zarr_layout.h -- describes a domain and moment as a group of Zarr arrays, and
// writes the metadata documents for both versions of the format.
//
// The group of a 2D product, such as mesh or composite.VEL, has the arrays of its values and states
// (time, y, x), with the attributes that its netCDF file has (render/still/map_attributes.h).
//
// The group of a moment has the arrays MOMENT and status (time, z, y, x), the coordinates time, z,
// y and x, the positions lat and lon (y, x), and the variable of the CF grid mapping. All have the
// attributes that grid files have (export/cf_attributes.h). In version 2, MOMENT and status also
// have the attribute _CRS, from which GDAL takes the projection. A grid in latitude and longitude
// has the dimensions lat and lon instead of y and x, and no positions. All chunks are compressed
// with gzip. Both versions have the same chunks.
//
// Sources   Zarr storage specification 2, with the consolidated metadata of zarr-python; Zarr core
//           specification 3.0, with the inline consolidated metadata of zarr-python 3.
// Threads   Pure functions.
// Errors    None.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "stormcellar/cache/grid_file.h"
#include "web/data/pictures/map_product.h"

namespace stormcellar::web {

using ZarrJson = nlohmann::ordered_json;

enum class ZarrNumber { float32, float64, int8, int32 };

struct ZarrArray {
    std::string name;
    ZarrNumber number = ZarrNumber::float64;
    std::vector<std::string> dimensions;
    std::vector<std::size_t> shape, chunk;  // as many as dimensions
    ZarrJson fill = {};
    ZarrJson attributes = ZarrJson::object();
    // More attributes for version 2. xarray could not write these to netCDF files.
    ZarrJson version2_attributes = ZarrJson::object();

    // Returns the number of chunks along a dimension.
    [[nodiscard]] std::size_t chunks_along(std::size_t dimension) const {
        return (shape[dimension] + chunk[dimension] - 1) / chunk[dimension];
    }
};

struct ZarrGroup {
    std::vector<ZarrArray> arrays;
    ZarrJson attributes = ZarrJson::object();

    // Returns the array of this name, or null if there is none.
    [[nodiscard]] const ZarrArray* find(std::string_view name) const;
};

inline constexpr std::size_t times_of_a_chunk = 4096;

// Return the group for grids at `times` times: of their moment, or of a product of them. The grids
// have the cells of `newest`.
[[nodiscard]] ZarrGroup zarr_group(std::string_view domain, const cache::GridDescription& newest,
                                   std::size_t times);
[[nodiscard]] ZarrGroup zarr_group_of_map(std::string_view domain,
                                          const cache::GridDescription& newest, std::size_t times,
                                          const MapStyle& style);

// Return the documents of version 2. The document .zgroup is always {"zarr_format": 2}.
[[nodiscard]] ZarrJson zarray_of(const ZarrArray& array);
[[nodiscard]] ZarrJson zattrs_of(const ZarrArray& array);
[[nodiscard]] ZarrJson zmetadata_of(const ZarrGroup& group);
// Return the document zarr.json of version 3: for an array, and for the group.
[[nodiscard]] ZarrJson zarr3_of(const ZarrArray& array);
[[nodiscard]] ZarrJson zarr3_of(const ZarrGroup& group);

}  // namespace stormcellar::web
