// export/grid_netcdf.h -- a grid as a CF-1.8 netCDF-4 file that xarray, IDV and ParaView open.
//
// Dimensions time (1), z, y, x. The field is named by its moment (REF), a float with _FillValue for
// every cell that holds no value; the byte variable `status` keeps the four states apart by
// flag_values and flag_meanings. Coordinates time, z, y, x in CF units, lat and lon of each column;
// grid mapping azimuthal_equidistant on WGS84; provenance as global attributes.
// The file is made in memory and appears whole or not at all (base/file_system.h); the same grid
// gives the same cells and attributes, which name no time of writing.
// Thread contract: any thread; calls wait for each other, because the netCDF library is not
// thread-safe.
#pragma once

#include <filesystem>

#include "base/file_system.h"
#include "base/result.h"
#include "grid/grid.h"

namespace stormcellar::netcdf {

struct GridWriteOptions {
    int deflate_level = 1;  // 0 to 9; 0: not compressed
};

// Errors: bad_argument for a grid whose arrays do not fit its spec or a deflate level out of range;
// io, no_space, permission and not_found from the file system; internal when netCDF refuses.
[[nodiscard]] Status write_grid(FileSystem& file_system, const std::filesystem::path& path,
                                const grid::Grid& grid, const GridWriteOptions& options = {});

}  // namespace stormcellar::netcdf
