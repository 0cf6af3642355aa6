// cli/grid/grid_options.h -- the options of `stormcellar grid` as they are typed, which several
// subcommands share. cli/grid/grid_request.h parses them.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/shared/commands.h"
#include "cli/shared/site_options.h"
#include "stormcellar/grid/grid_spec.h"
#include "stormcellar/level2/volume.h"
#include "stormcellar/retrieve/hail.h"

namespace stormcellar::cli {

// The options as they were typed.
struct GridOptions {
    std::vector<std::string> files;
    std::string output;
    std::string center;
    std::string_view center_option = "--center";  // or --at, as typed
    std::string projection{grid::projection_name(grid::Projection::azimuthal_equidistant)};
    std::string parallels;
    std::string extent_km, extent_deg;
    std::optional<double> spacing_km, spacing_deg;
    std::string levels_km;
    std::string moment{level2::moment_name(level2::Moment::ref)};
    std::string dealias;       // empty: not typed
    std::string storm_motion;  // empty: not typed
    double quality = 0;        // least probability of weather; 0: all echo
    double zero_c_m = retrieve::FreezingLevels{}.zero_c_m;  // that HCA may assume
    bool takes_moments = false;  // --moment may name several moments, or "all"
    // Height of 0 C that a product assumes: notes say if the melting layer is elsewhere.
    std::optional<double> assumed_zero_c_m;
    std::string time, fields;
    SiteOptions site;
    int volume = 0;   // number from 1; 0: none was typed
    int threads = 0;  // 0: as many as the machine has
    bool json = false;
};

// Adds FILE, --output, --time, --fields, --volume and the options of add_spec_options(). Also lets
// --moment name several moments.
void add_grid_options(CLI::App& app, GridOptions& options);
// Adds the options for the center of the grid, its cells and its levels.
void add_place_options(CLI::App& app, GridOptions& options);
// Adds --volume, which chooses one volume of a file, or of a directory of chunks.
void add_volume_option(CLI::App& app, GridOptions& options);
// Adds --dealias, --storm-motion and --quality.
void add_derivation_options(CLI::App& app, GridOptions& options);
// Adds the options for the grid, the moment and the number of threads.
void add_spec_options(CLI::App& app, GridOptions& options);

// Returns a list of the known projections with their short names, such as "azimuthal_equidistant
// (aeqd), latitude_longitude (lat-lon, latlon)".
[[nodiscard]] std::string known_projections(std::string_view before_last);

}  // namespace stormcellar::cli
