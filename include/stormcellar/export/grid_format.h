// stormcellar/export/grid_format.h -- the formats that a grid can be written in.
//
// Each format has one row in a registry. A writer of grids chooses the format by the name of the
// file; help and messages list the registry.
//
// Threads   Any thread. Each format says whether its calls wait for each other.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/base/file_system.h"
#include "stormcellar/base/result.h"
#include "stormcellar/grid/grid.h"

namespace stormcellar::grid_export {

// A surface on which the values of a grid equal `value`, and its color in sRGB.
struct GridSurface {
    double value = 0;
    std::array<std::uint8_t, 3> color = {255, 255, 255};
};
inline constexpr std::size_t most_surfaces = 16;

// Choices that only some formats use. The other formats ignore these choices.
struct GridFormatOptions {
    std::vector<GridSurface> surfaces;  // the outermost first
    double height_scale = 1;            // factor on heights
};

struct GridFormat {
    std::string_view name;                      // "netCDF"
    std::span<const std::string_view> endings;  // of file names; the first is the usual one
    // Writes the grids of one or several moments into one file or directory, whole or not at all.
    // The grids share their cells and their time. Errors: bad_argument for grids that the format
    // cannot hold; internal if a library refuses; those of the file system.
    Status (*write)(FileSystem& file_system, const std::filesystem::path& path,
                    std::span<const grid::Grid> grids, const GridFormatOptions& options);
    // For a format that writes a directory: checks, before long work, that the directory can be
    // written. Null for a format that writes a file.
    Status (*check_directory)(const std::filesystem::path& path) = nullptr;
    bool has_surfaces = false;  // true if the format takes the surfaces and the factor on heights
};

// Returns all formats. The first one is the default if no file name chooses one.
[[nodiscard]] std::span<const GridFormat> grid_formats();

// Finds a format by the ending of a file's name. Returns null if no format has this ending.
[[nodiscard]] const GridFormat* grid_format_of(std::string_view file_name);

// grid_endings() returns the endings of all formats; known_grid_formats() returns the names with
// their endings for messages: "netCDF (.nc, .nc4)".
[[nodiscard]] std::vector<std::string_view> grid_endings();
[[nodiscard]] std::string known_grid_formats();

}  // namespace stormcellar::grid_export
