// cli/grid/surface_options.h -- the options for formats that hold the surfaces of a grid.
#pragma once

#include <optional>
#include <span>
#include <string>

#include <CLI/CLI.hpp>

#include "stormcellar/base/result.h"
#include "stormcellar/export/grid_format.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::cli {

// The options as they were typed.
struct SurfaceOptions {
    std::string values;                  // of --surfaces; empty: not typed
    std::optional<double> exaggeration;  // none: not typed
};

void add_surface_options(CLI::App& app, SurfaceOptions& options);

// Returns the surfaces for a grid of these moments, with the colors of the moment's default table.
// The outermost comes first. Reflectivity has surfaces by default. Errors: bad_argument for options
// that the format does not take, for several moments, for missing values, and for values that are
// not numbers.
[[nodiscard]] Result<grid_export::GridFormatOptions> parse_surfaces(
    const SurfaceOptions& options, const grid_export::GridFormat& format,
    std::span<const level2::Moment> moments);

}  // namespace stormcellar::cli
