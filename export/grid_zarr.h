// export/grid_zarr.h -- writes a grid, or the grids of several moments, as a Zarr store: a
// directory that xarray, zarr-python and GDAL open; internal.
//
// The arrays, their names and their attributes are those of netCDF files
// (stormcellar/export/grid_netcdf.h). Layout and chunks are those of the data server
// (export/zarr_layout.h). The array of states has the fill value 4, unavailable, so that a reader
// shows a missing file as unknown.
//
// The directory is filled beside its final name and appears whole or not at all
// (base/atomic_directory.h). An older Zarr group of this name is replaced; any other directory that
// holds files is an error. Besides the grid, one chunk is in memory.
//
// Units     CF units, named in the attributes.
// Threads   Any thread may call.
// Errors    bad_argument for grids that one file cannot hold and for a directory that is no Zarr
//           group; io, no_space, permission, not_a_file and not_found from the file system.
// Accuracy  Values are the grid's own floats.
#pragma once

#include <filesystem>
#include <span>

#include "export/zarr_layout.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/base/result.h"
#include "stormcellar/grid/grid.h"

namespace stormcellar::zarr {

// Checks, before long work, that the store can be written at this path.
[[nodiscard]] Status check_store(const std::filesystem::path& path);
[[nodiscard]] Status write_store(FileSystem& file_system, const std::filesystem::path& path,
                                 std::span<const grid::Grid> grids, ZarrVersion version);

}  // namespace stormcellar::zarr
