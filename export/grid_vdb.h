// export/grid_vdb.h -- writes grids as an OpenVDB file (.vdb), which Blender and Houdini open;
// internal.
//
// Each moment is a FloatGrid with the moment's name, such as "REF". A voxel is active if the cell
// has a value. All other voxels have the background: -33 dBZ for reflectivity, else 0. A FloatGrid
// beside it, "REF_status", has the states of cells; its background is 0, not seen. (States are
// floats because OpenVDB's Python module reads no integers.)
//
// The transform gives meters: x east and y north of the grid's center, z up from mean sea level. A
// grid in degrees becomes a plane with the size that its cells have at its center. Both grids have
// the attributes of netCDF files as metadata, with method and predicted_error, and the moment, its
// units, the time, the place of the center and the projection.
//
// OpenVDB is in the module stormcellar_vdb.so, which is loaded when the first file is written. The
// file is made in memory. Voxels and file need at most twice the memory of the grid. A grid with a
// storm needs far less.
//
// Units     Meters and the moment's unit.
// Threads   Any thread may call.
// Errors    unsupported for levels that are not equally far apart, a build without OpenVDB
//           (STORMCELLAR_VDB) and a module that cannot be loaded; exhausted without memory;
//           internal if OpenVDB refuses; those of check_grids() (export/grid_fields.h) and of the
//           file system.
// Accuracy  Values are the grid's own floats. The same grids give the same bytes.
// Source    OpenVDB 10, file version 224.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "stormcellar/base/file_system.h"
#include "stormcellar/base/result.h"
#include "stormcellar/export/grid_format.h"
#include "stormcellar/grid/grid.h"

namespace stormcellar::vdb {

[[nodiscard]] Result<std::string> vdb_bytes(std::span<const grid::Grid> grids);
[[nodiscard]] Status write_vdb(FileSystem& file_system, const std::filesystem::path& path,
                               std::span<const grid::Grid> grids,
                               const grid_export::GridFormatOptions& options);

// The function that the module exports, with C linkage.
using VdbEntry = void (*)(std::span<const grid::Grid> grids, Result<std::string>& bytes);
inline constexpr const char* module_file = "stormcellar_vdb.so";
inline constexpr const char* module_entry = "stormcellar_vdb_file";

}  // namespace stormcellar::vdb
