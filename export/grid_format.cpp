#include "stormcellar/export/grid_format.h"

#include <algorithm>
#include <array>

#include <fmt/ranges.h>

#include "stormcellar/export/grid_netcdf.h"

namespace stormcellar::grid_export {
namespace {

constexpr std::array<std::string_view, 2> netcdf_endings{".nc", ".nc4"};

Status write_netcdf(FileSystem& file_system, const std::filesystem::path& path,
                    std::span<const grid::Grid> grids) {
    return netcdf::write_grids(file_system, path, grids);
}

constexpr std::array formats{GridFormat{"netCDF", netcdf_endings, write_netcdf}};

}  // namespace

std::span<const GridFormat> grid_formats() {
    return formats;
}

const GridFormat* grid_format_of(std::string_view file_name) {
    for (const GridFormat& format : formats) {
        const auto fits = [&](std::string_view ending) { return file_name.ends_with(ending); };
        if (std::ranges::any_of(format.endings, fits)) return &format;
    }
    return nullptr;
}

std::vector<std::string_view> grid_endings() {
    std::vector<std::string_view> all;
    for (const GridFormat& format : formats)
        all.insert(all.end(), format.endings.begin(), format.endings.end());
    return all;
}

std::string known_grid_formats() {
    std::vector<std::string> known;
    for (const GridFormat& format : formats)
        known.push_back(fmt::format("{} ({})", format.name, fmt::join(format.endings, ", ")));
    return fmt::format("{}", fmt::join(known, " or "));
}

}  // namespace stormcellar::grid_export
