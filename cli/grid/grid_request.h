// cli/grid/grid_request.h -- the options of `stormcellar grid`, and their parsed form.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/shared/commands.h"
#include "cli/shared/input_files.h"
#include "cli/shared/site_options.h"
#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/grid/cell_details.h"
#include "stormcellar/grid/grid_spec.h"
#include "stormcellar/level2/volume.h"
#include "stormcellar/retrieve/derived_moments.h"

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
    std::string dealias;         // empty: not typed
    std::string storm_motion;    // empty: not typed
    double quality = 0;          // least probability of weather; 0: all echo
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
// Adds --dealias and --quality.
void add_derivation_options(CLI::App& app, GridOptions& options);
// Adds the options for the grid, the moment and the number of threads.
void add_spec_options(CLI::App& app, GridOptions& options);

enum class SizeUnit { km, degrees };

// The options, parsed as far as is possible while the site is unknown.
struct GridRequest {
    std::optional<std::array<double, 2>> center_deg;
    grid::Projection projection = grid::Projection::azimuthal_equidistant;
    std::optional<std::array<double, 2>> parallels_deg;
    std::array<double, 2> extent = {460, 460};  // full width and height
    bool extent_given = false;
    SizeUnit extent_unit = SizeUnit::km;
    double spacing = 1;
    SizeUnit spacing_unit = SizeUnit::km;  // degrees are only for latitude_longitude
    std::vector<double> levels_m;          // empty: those of grid::default_spec()
    level2::Moment moment = level2::Moment::ref;
    std::vector<level2::Moment> more_moments;  // besides `moment`, in the order of level2::Moment
    retrieve::DerivedOptions derived;          // for moments that are derived
    std::optional<double> assumed_zero_c_m;    // as in GridOptions
    // Plans the rung of dealiasing for a volume; null: as in `derived`.
    std::function<Result<retrieve::Dealiasing>(const level2::Volume&)> plan_dealiasing;
    bool any_moment = false;            // --moment all: leave out moments that no volume has
    std::optional<UtcTime> frame_time;  // selects the sweeps nearest to this time
    grid::DetailSet details;            // with one file: the details to keep for each cell
    bool site_counts = false;           // with several files: count the sites of each cell
    bool site_weights = false;
    SiteRequest site;  // applies to every file
    // Number of the volume in the single file, from 1. 0: the first volume with the moment, or the
    // newest volume of a directory of chunks.
    int volume = 0;
    // The files found for the names; null: each name is one file.
    std::shared_ptr<InputFiles> inputs;
    int threads = 1;

    // Returns all moments to be gridded.
    [[nodiscard]] std::vector<level2::Moment> moments() const;
};

// Returns the named files. Replaces archives and directories by the files in them. Errors: those of
// InputFiles::find().
[[nodiscard]] Result<std::shared_ptr<InputFiles>> find_inputs(GridOptions& options);

// Parses the options. Checks the spec as well if --center is given, or if the center does not
// matter for the check. Errors: bad_argument, naming the option.
[[nodiscard]] Result<GridRequest> parse_request(const GridOptions& options);

// Returns the requested grid about --center. Without --center, the given point, which must be
// valid, is the center. For a latitude-longitude grid, converts kilometers to degrees at the center
// and rounds up to whole cells.
[[nodiscard]] Result<grid::GridSpec> spec_about(const GridRequest& request, double latitude_deg,
                                                double longitude_deg);

}  // namespace stormcellar::cli
