// stormcellar/export/grid_format.h -- the formats that a grid can be written in.
//
// One row a format. What writes a grid takes its format from the name of the file; help and
// messages list what the registry holds.
// Thread contract: any thread. A format says itself whether its calls wait for each other.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/base/file_system.h"
#include "stormcellar/base/result.h"
#include "stormcellar/grid/grid.h"

namespace stormcellar::grid_export {

struct GridFormat {
    std::string_view name;                      // "netCDF"
    std::span<const std::string_view> endings;  // of its files; the first one is the usual one
    // Writes the grids of one or several moments into one file, whole or not at all. They share
    // their cells and their time. Errors: bad_argument for grids that the format does not hold, and
    // those of the file system.
    Status (*write)(FileSystem& file_system, const std::filesystem::path& path,
                    std::span<const grid::Grid> grids);
};

// The first one is the default, where no name says which.
[[nodiscard]] std::span<const GridFormat> grid_formats();

// By the ending of a file's name. Null: no format has this ending.
[[nodiscard]] const GridFormat* grid_format_of(std::string_view file_name);

// The endings of all formats, and the names with them as a user reads them: "netCDF (.nc, .nc4)".
[[nodiscard]] std::vector<std::string_view> grid_endings();
[[nodiscard]] std::string known_grid_formats();

}  // namespace stormcellar::grid_export
