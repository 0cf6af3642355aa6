// stormcellar/export/grid_netcdf.h -- a grid as a CF-1.8 netCDF-4 file that xarray, IDV and
// ParaView open.
//
// Dimensions time (1), z, y, x. The field is named by its moment (REF), a float with _FillValue for
// every cell that holds no value; the byte variable `status` keeps the four states apart by
// flag_values and flag_meanings. Where the grid has details (stormcellar/grid/cell_details.h), they
// are floats beside it: age (s, from the time coordinate), beam_height_offset and gate_distance (m)
// and sample_weight (1), _FillValue where nothing is known. Where a mosaic has them, site_count
// (short, how many sites see a cell) and site_weight (float, the sum of their weights), 0 where
// none does. The time is the frame time, which is the start of the volume unless another was asked
// for. Coordinates time, z, y, x in CF units and the grid mapping of the projection on WGS84
// (export/grid_coordinates.h); provenance as global attributes. The file is made in memory and
// appears whole or not at all (stormcellar/base/file_system.h); the same grid gives the same cells
// and attributes, which name no time of writing. Thread contract: any thread; calls wait for each
// other, because the netCDF library is not thread-safe.
#pragma once

#include <filesystem>

#include "stormcellar/base/file_system.h"
#include "stormcellar/base/result.h"
#include "stormcellar/grid/grid.h"

namespace stormcellar::netcdf {

struct GridWriteOptions {
    int deflate_level = 1;  // 0 to 9; 0: not compressed
};

// Errors: bad_argument for a grid whose arrays do not fit its spec or a deflate level out of range;
// io, no_space, permission and not_found from the file system; internal when netCDF refuses.
[[nodiscard]] Status write_grid(FileSystem& file_system, const std::filesystem::path& path,
                                const grid::Grid& grid, const GridWriteOptions& options = {});

}  // namespace stormcellar::netcdf
