// stormcellar/export/grid_netcdf.h -- writes a grid, or the grids of several moments, as a CF-1.8
// netCDF-4 file that xarray, IDV and ParaView open.
//
// The dimensions are time (1), z, y and x, or, for a latitude-longitude grid, time, z, lat and lon.
// The field has the name of its moment (REF); it is a float, with _FillValue in every cell that
// holds no value. The byte variable `status` tells the four states apart by flag_values and
// flag_meanings.
//
// If the grid has details (stormcellar/grid/cell_details.h), they are floats too: age (s, from the
// time coordinate), beam_height_offset and gate_distance (m) and sample_weight (1), with _FillValue
// where nothing is known. If a mosaic has details, site_count (short) says how many sites see a
// cell and site_weight (float) is the sum of their weights; both are 0 where no site sees the cell.
//
// Several grids, of different moments on the same cells and at the same time, become one file with
// one field each. Then the names of variables that belong to a moment begin with its name
// (REF_status, VEL_age), and the method, the effects, the predicted error, the beam model and the
// averaging are attributes of the field instead of the file; audits are left out.
//
// The time is the frame time if the grid was made for a frame time, else the start of the volume.
// The coordinates are in CF units, with the grid mapping of the projection on WGS84
// (export/grid_coordinates.h). Global attributes hold the provenance.
//
// The file is made in memory and appears whole or not at all (stormcellar/base/file_system.h). The
// same grid gives the same cells and attributes, which do not name the time of writing.
//
// Units     CF units, named in the file.
// Threads   Any thread may call. Calls wait for each other, because the netCDF library is not
//           thread-safe.
// Errors    See write_grid().
// Accuracy  Values are the grid's own floats.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "stormcellar/base/file_system.h"
#include "stormcellar/base/result.h"
#include "stormcellar/grid/grid.h"

namespace stormcellar::netcdf {

struct GridWriteOptions {
    int deflate_level = 1;  // 0 to 9; 0: not compressed
};

// Writes the file. Errors: bad_argument for a grid whose arrays do not fit its spec, or a deflate
// level out of range; io, no_space, permission, not_a_file and not_found from the file system;
// internal if netCDF refuses.
[[nodiscard]] Status write_grid(FileSystem& file_system, const std::filesystem::path& path,
                                const grid::Grid& grid, const GridWriteOptions& options = {});
// Writes the grids of several moments to one file. A single grid gives the same file as
// write_grid(). Errors: those of write_grid(); bad_argument for no grid, for two grids of one
// moment, and for grids whose cells or times differ.
[[nodiscard]] Status write_grids(FileSystem& file_system, const std::filesystem::path& path,
                                 std::span<const grid::Grid> grids,
                                 const GridWriteOptions& options = {});

// Returns the bytes that write_grids() would write, without a file. Errors: bad_argument and
// internal, as for write_grids().
[[nodiscard]] Result<std::vector<std::byte>> grid_file_bytes(std::span<const grid::Grid> grids,
                                                             const GridWriteOptions& options = {});

}  // namespace stormcellar::netcdf
