// cli/loop/archive_options.h -- the options of `loop --catalog`: stations, times and grid.
#pragma once

#include <array>
#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "cli/grid/grid_request.h"
#include "cli/shared/commands.h"
#include "grid/mosaic/time_interpolation.h"
#include "pipeline/options/domain.h"
#include "stormcellar/base/result.h"
#include "stormcellar/grid/mosaic.h"

namespace stormcellar::cli {

// The options as they were typed.
struct ArchiveOptions {
    std::string catalog;
    std::string stations;  // "KBGM,KENX"
    std::string bounds;    // "W,S,E,N"
    GridOptions place;     // center, projection, extent, spacing, levels
    std::string overlap;
    std::optional<double> overlap_km;
    bool keep_cache = true;

    [[nodiscard]] bool asked() const { return !catalog.empty(); }
};

// Adds --overlap and --overlap-km.
void add_overlap_options(CLI::App& app, ArchiveOptions& options, const std::string& group);
// Adds the options to the subcommand. `options` must outlive the parse.
void add_archive_options(CLI::App& app, ArchiveOptions& options);

struct ArchiveRequest {
    std::vector<std::string> stations;  // as typed; empty: the stations that reach the bounds
    std::optional<pipeline::Bounds> bounds;
    GridRequest place;
    bool spacing_given = false;
    bool place_given = false;  // true: a center or a projection was given
    std::optional<grid::Overlap> overlap;
    double overlap_length_m = 250'000;
};

// Parses the options. Errors: bad_argument, naming the option, also for an option that needs
// --catalog.
[[nodiscard]] Result<ArchiveRequest> parse_archive(const ArchiveOptions& options);

// Returns the requested grid, which holds the bounds. Without bounds, the grid has the typed
// extent, or else holds the sites and 230 km around them. If neither extent nor spacing was typed,
// the spacing is the smallest of 1, 2 and 4 km that gives at most 1024 cells a side, else 8 km.
[[nodiscard]] Result<grid::GridSpec> archive_spec(const ArchiveRequest& request,
                                                  const std::vector<grid::SitePosition>& sites);

// Parses an interval such as "300", "90s", "5min" or "1h". Errors: bad_argument, naming the option.
[[nodiscard]] Result<std::chrono::seconds> parse_interval(const std::string& option,
                                                          const std::string& text);

}  // namespace stormcellar::cli
