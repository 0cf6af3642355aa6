#include "cli/grid/grid_options.h"

#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "base/name_list.h"
#include "grid/frame/named_place.h"
#include "stormcellar/export/grid_format.h"
#include "stormcellar/retrieve/derived_moments.h"

namespace stormcellar::cli {

std::string known_projections(std::string_view before_last) {
    struct Named {
        std::string name;
    };
    std::vector<Named> all;
    for (const grid::ProjectionFacts& facts : grid::projection_facts) {
        std::string shorter;
        for (const std::string_view name : facts.short_names) {
            if (!shorter.empty() && !name.empty()) shorter += ", ";
            shorter += name;
        }
        all.push_back({shorter.empty() ? std::string(facts.name)
                                       : fmt::format("{} ({})", facts.name, shorter)});
    }
    return names_in(all, ", ", before_last);
}

void add_grid_options(CLI::App& app, GridOptions& options) {
    options.takes_moments = true;
    app.add_option("FILE", options.files,
                   "The Level II files to grid; several files give a mosaic of their sites and "
                   "times. Tar and zip archives, directories and - for standard input work too")
        ->required();
    app.add_option(
           "-o,--output", options.output,
           fmt::format("The file to write, as {}; - writes {} to standard output",
                       grid_export::known_grid_formats(), grid_export::grid_formats().front().name))
        ->required();
    add_volume_option(app, options);
    add_spec_options(app, options);
    app.add_option("--time", options.time,
                   "Time of the grid in UTC (ISO 8601). With one FILE, the grid uses the sweeps "
                   "nearest to this time instead of the newest at each elevation, and ages count "
                   "from this time instead of the start of the volume. With several FILEs, all of "
                   "them are brought to this instant. Default for several: the middle of the times "
                   "of the newest volumes, or the newest of these times if they are far apart");
    app.add_option("--fields", options.fields,
                   "Details to write beside the value, separated by commas, or all. For one FILE: "
                   "age (s), height_offset (m above the nearest beam), distance (m to the nearest "
                   "gate) and weight (the share that was seen). For several FILEs: counts (how "
                   "many sites see a cell) and weights (the sum of their weights)");
}

void add_volume_option(CLI::App& app, GridOptions& options) {
    app.add_option("--volume", options.volume,
                   "Number of the volume, from 1, if FILE holds several or is a directory with "
                   "chunks of several. Default: the first with the moment; of chunks, the newest")
        ->check(CLI::Range(1, 1000));
}

void add_place_options(CLI::App& app, GridOptions& options) {
    CLI::Option* center = app.add_option(
        "--center", options.center,
        fmt::format("Center of the grid: {}. Default: the site, or the middle of the sites",
                    grid::place_for_help));
    app.add_option_function<std::string>(
           "--at",
           [&options](const std::string& place) {
               options.center = place;
               options.center_option = "--at";
           },
           "Another name of --center")
        ->excludes(center);
    app.add_option("--projection", options.projection,
                   fmt::format("Projection of the grid: {}", known_projections(" or ")))
        ->capture_default_str();
    app.add_option(
        "--parallels", options.parallels,
        "Standard parallels of lambert_conformal: LAT1,LAT2. Default: the latitude of the center");
    app.add_option("--extent-km", options.extent_km,
                   "Full width and height of the grid in km. Default: 460,460 for one site; for "
                   "several, 230 km beyond them");
    app.add_option("--spacing-km", options.spacing_km,
                   "Distance from one cell to the next in km. Default: 1. For latitude_longitude, "
                   "km become degrees as they are at the center: of latitude for the spacing and "
                   "the height, of longitude for the width, rounded up to whole cells");
    app.add_option("--extent-deg", options.extent_deg,
                   "Full width and height of a latitude_longitude grid in degrees, such as 6,4");
    app.add_option(
        "--spacing-deg", options.spacing_deg,
        "Distance from one cell of a latitude_longitude grid to the next in degrees, both ways");
    app.add_option("--levels-km", options.levels_km,
                   "Heights of the levels in km above mean sea level: a,b,c or bottom:top:step. "
                   "Default: 0.5:16:0.5");
}

void add_derivation_options(CLI::App& app, GridOptions& options) {
    app.add_option("--dealias", options.dealias,
                   fmt::format("How to dealias the velocity (VELD instead of VEL): {}",
                               retrieve::dealiasing_names()))
        ->default_str("off");
    app.add_option("--storm-motion", options.storm_motion,
                   fmt::format("The motion to which the storm-relative velocity, SRV, refers: {}",
                               retrieve::motion_choices()))
        ->default_str(std::string(retrieve::automatic_motion));
    app.add_option("--quality", options.quality,
                   "Leave out echo whose probability of weather is less than this, from 0 to 1. "
                   "0.5 leaves out most birds, insects and ground. Default: 0, which keeps all");
}

void add_spec_options(CLI::App& app, GridOptions& options) {
    add_place_options(app, options);
    add_site_options(app, options.site);
    app.add_option("--moment", options.moment,
                   fmt::format("The moment to grid: {}{}", level2::moment_names(", ", " or "),
                               options.takes_moments
                                   ? "; several, separated by commas, or all that the volume holds "
                                     "(all) become one file, decoded once, with a variable each"
                                   : ""))
        ->capture_default_str();
    add_derivation_options(app, options);
    app.add_option("--threads", options.threads,
                   options.threads == 0
                       ? std::string{"Number of threads. Default: all processors"}
                       : fmt::format("Number of threads. Default: {}", options.threads))
        ->check(CLI::Range(1, 256));
    app.add_flag("--json", options.json,
                 "Print one JSON document with the facts and the time of each phase");
}

}  // namespace stormcellar::cli
