// cli/grid/grid_request.h -- the options of `stormcellar grid`, parsed.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/grid/grid_options.h"
#include "cli/shared/input_files.h"
#include "cli/shared/site_options.h"
#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/grid/cell_details.h"
#include "stormcellar/grid/grid_spec.h"
#include "stormcellar/level2/volume.h"
#include "stormcellar/retrieve/derived_moments.h"

namespace stormcellar::cli {

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
    // Plans the rung of dealiasing for a volume; null: takes the rung in `derived`.
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
