// export/grid_gltf.h -- writes surfaces of a grid as a binary glTF 2.0 file (.glb), which Blender,
// web browsers and game engines open; internal.
//
// Each surface encloses the air whose values are at or above its own (export/surface_mesh.h). It is
// one node and one mesh, with the name "REF 45 dBZ" and a material of its color. If there are
// several surfaces, all but the last are translucent: the k-th of n has the alpha k/n. A surface
// that the grid does not reach is left out.
//
// The origin is the center of the grid at mean sea level: x is east, y is up, z is south. The
// `extras` of the scene hold the place of the origin, the projection, the time, the factor on
// heights and the attributes of netCDF files, with method and predicted_error.
//
// Units     Meters, as glTF has them.
// Threads   Any thread may call.
// Errors    bad_argument for several grids, for no or too many surfaces, for a factor that is not
//           above 0, for a grid that reaches no surface, and for more than 4 GB; those of
//           check_grids() (export/grid_fields.h) and of the file system.
// Source    glTF 2.0 specification, Khronos Group (2021).
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "stormcellar/base/file_system.h"
#include "stormcellar/base/result.h"
#include "stormcellar/export/grid_format.h"
#include "stormcellar/grid/grid.h"

namespace stormcellar::surfaces {

[[nodiscard]] Result<std::vector<std::byte>> gltf_bytes(
    std::span<const grid::Grid> grids, const grid_export::GridFormatOptions& options);
[[nodiscard]] Status write_gltf(FileSystem& file_system, const std::filesystem::path& path,
                                std::span<const grid::Grid> grids,
                                const grid_export::GridFormatOptions& options);

}  // namespace stormcellar::surfaces
