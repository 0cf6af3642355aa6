// export/zarr_layout.h -- describes gridded data as a group of Zarr arrays, and writes the metadata
// documents for both versions of the format; internal.
//
// Stores on disk (export/grid_zarr.h) and arrays over HTTP (web/data/zarr/zarr_layout.h) take their
// arrays, chunks and documents from here. All arrays have the attributes that netCDF files have
// (export/cf_attributes.h). In version 2, arrays of cells also have the attribute _CRS, from which
// GDAL takes the projection. All chunks are compressed with gzip. Both versions have the same
// chunks.
//
// Sources   Zarr storage specification 2, with the consolidated metadata of zarr-python; Zarr core
//           specification 3.0, with the inline consolidated metadata of zarr-python 3.
// Threads   Pure functions.
// Errors    None.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "export/cf_attributes.h"
#include "stormcellar/grid/grid_spec.h"

namespace stormcellar::zarr {

using ZarrJson = nlohmann::ordered_json;

enum class ZarrVersion { two = 2, three = 3 };
// Version 2 has no `text`.
enum class ZarrNumber { float32, float64, int8, int16, int32, uint8, int64, text };
// The compression of chunks. Version 2 has only gzip.
enum class ZarrPacking { gzip, zstd };

struct ZarrArray {
    std::string name;
    ZarrNumber number = ZarrNumber::float64;
    std::vector<std::string> dimensions;
    std::vector<std::size_t> shape, chunk;  // as many as dimensions
    ZarrJson fill = {};
    ZarrPacking packing = ZarrPacking::gzip;
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

// A chunk has `chunk_side` columns and rows, and all levels, but at most `chunk_side` levels.
inline constexpr int chunk_side = 128;
[[nodiscard]] int chunk_levels(const grid::GridSpec& spec);
inline constexpr int gzip_level = 4;
inline constexpr int zstd_level = 1;
// The fill value of states means that a chunk is missing or cannot be read. No cell has this state.
// So a reader that takes an error for a missing chunk does not show "not seen".
inline constexpr std::int8_t status_unavailable = 4;

[[nodiscard]] ZarrJson json_of(const netcdf::CfAttributes& attributes);

// Returns a coordinate along a dimension of the same name.
[[nodiscard]] ZarrArray axis(std::string name, std::size_t size, std::size_t chunk,
                             const netcdf::CfAttributes& attributes);
// Returns the shape and the chunks of an array (time, z, y, x) of cells, without its name, number
// and attributes.
[[nodiscard]] ZarrArray array_of_cells(const grid::GridSpec& spec, std::size_t times);
// Adds the attributes that place an array on the map of its cells.
void place_on_map(ZarrArray& array, const grid::GridSpec& spec);
// The states of an array, and the flag for cells of missing chunks.
struct Flags {
    std::vector<int> values = {};
    std::string meanings = {};  // each followed by a blank
    std::int8_t unavailable = status_unavailable;
    std::string_view comment;  // when cells are unavailable
};
// Makes an array one of states: adds its number, its fill value and the attributes of the flags.
void add_flags(ZarrArray& array, Flags flags);
// Returns the coordinates and positions of rows and columns, and the variable of the CF grid
// mapping.
[[nodiscard]] std::vector<ZarrArray> map_arrays(const grid::GridSpec& spec);

// Return the documents of version 2. The document .zgroup is always {"zarr_format": 2}.
[[nodiscard]] ZarrJson zarray_of(const ZarrArray& array);
[[nodiscard]] ZarrJson zattrs_of(const ZarrArray& array);
[[nodiscard]] ZarrJson zmetadata_of(const ZarrGroup& group);
// Return the document zarr.json of version 3: for an array, and for the group.
[[nodiscard]] ZarrJson zarr3_of(const ZarrArray& array);
[[nodiscard]] ZarrJson zarr3_of(const ZarrGroup& group);
// Returns the text of a document.
[[nodiscard]] std::string text_of(const ZarrJson& document);

}  // namespace stormcellar::zarr
