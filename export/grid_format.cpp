#include "stormcellar/export/grid_format.h"

#include <array>

#include "base/format_list.h"
#include "export/grid_gltf.h"
#include "export/grid_vdb.h"
#include "export/grid_zarr.h"
#include "stormcellar/export/grid_netcdf.h"

namespace stormcellar::grid_export {
namespace {

constexpr std::array<std::string_view, 2> netcdf_endings{".nc", ".nc4"};
constexpr std::array<std::string_view, 1> zarr2_endings{".zarr"};
constexpr std::array<std::string_view, 1> zarr3_endings{".zarr3"};
constexpr std::array<std::string_view, 1> vdb_endings{".vdb"};
constexpr std::array<std::string_view, 1> gltf_endings{".glb"};

Status write_netcdf(FileSystem& file_system, const std::filesystem::path& path,
                    std::span<const grid::Grid> grids, const GridFormatOptions& /*options*/) {
    return netcdf::write_grids(file_system, path, grids);
}

Status write_zarr2(FileSystem& file_system, const std::filesystem::path& path,
                   std::span<const grid::Grid> grids, const GridFormatOptions& /*options*/) {
    return zarr::write_store(file_system, path, grids, zarr::ZarrVersion::two);
}

Status write_zarr3(FileSystem& file_system, const std::filesystem::path& path,
                   std::span<const grid::Grid> grids, const GridFormatOptions& /*options*/) {
    return zarr::write_store(file_system, path, grids, zarr::ZarrVersion::three);
}

constexpr std::array formats{
    GridFormat{"netCDF", netcdf_endings, write_netcdf},
    GridFormat{"Zarr 2", zarr2_endings, write_zarr2, zarr::check_store},
    GridFormat{"Zarr 3", zarr3_endings, write_zarr3, zarr::check_store},
    GridFormat{"OpenVDB", vdb_endings, vdb::write_vdb},
    GridFormat{"glTF surfaces", gltf_endings, surfaces::write_gltf, nullptr, true},
};

}  // namespace

std::span<const GridFormat> grid_formats() {
    return formats;
}

const GridFormat* grid_format_of(std::string_view file_name) {
    return find_format(grid_formats(), file_name);
}

std::vector<std::string_view> grid_endings() {
    return endings_in(grid_formats());
}

std::string known_grid_formats() {
    return formats_in(grid_formats());
}

}  // namespace stormcellar::grid_export
