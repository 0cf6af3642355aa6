// cli/grid/grid_files.h -- grids the files of a command line: one file, or a mosaic of several.
//
// Threads   Pure functions. They read the files and use request.threads threads.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/grid/grid_mosaic.h"
#include "cli/grid/grid_report.h"
#include "cli/grid/grid_request.h"
#include "cli/grid/volume_source.h"
#include "cli/shared/effect_options.h"
#include "stormcellar/accuracy/plan.h"
#include "stormcellar/base/result.h"
#include "stormcellar/grid/grid.h"
#include "stormcellar/grid/mosaic.h"

namespace stormcellar::cli {

// The parsed options of one moment.
struct MomentRequest {
    level2::Moment moment = level2::Moment::ref;
    EffectRequest effects;
    grid::MosaicOptions mosaic;  // for several files
};
// Returns the options of each moment of the request. Errors: bad_argument, naming the option.
[[nodiscard]] Result<std::vector<MomentRequest>> parse_each_moment(
    const GridOptions& options, const GridRequest& request, const EffectOptions& effect_options,
    const MosaicOptions& mosaic_options);

// A grid, with its plan if a plan was requested.
struct MadeGrid {
    grid::Grid grid;
    std::optional<accuracy::Plan> plan;

    // Returns true if the plan does not meet the budget. The grid is then empty.
    [[nodiscard]] bool has_failed() const { return plan && !plan->meets_budget; }
};

// Returns a grid of each requested moment. Stops after the first grid that does not meet its
// budget. Adds the times of the phases to the timings. Moves the decoded volumes into `kept` unless
// `kept` is null. Errors name the file.
[[nodiscard]] Result<std::vector<MadeGrid>> grid_inputs(const std::vector<std::string>& files,
                                                        const GridRequest& request,
                                                        const std::vector<MomentRequest>& moments,
                                                        GridTimings& timings,
                                                        std::vector<SourceVolume>* kept = nullptr);

}  // namespace stormcellar::cli
