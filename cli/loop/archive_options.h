// cli/loop/archive_options.h -- what `loop --catalog` was asked for: which stations, times and
// grid.
#pragma once

#include <array>
#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "cli/grid/grid_request.h"
#include "grid/mosaic/time_interpolation.h"
#include "pipeline/options/domain.h"
#include "stormcellar/base/result.h"
#include "stormcellar/grid/mosaic.h"

namespace CLI {
class App;
}

namespace stormcellar::cli {

// As they were typed.
struct ArchiveOptions {
    std::string catalog;
    std::string stations;  // "KBGM,KENX"
    std::string bounds;    // "W,S,E,N"
    GridOptions place;     // centre, projection, extent, spacing, levels
    std::string overlap;
    std::optional<double> overlap_km;
    bool keep_cache = true;

    [[nodiscard]] bool asked() const { return !catalog.empty(); }
};

// Puts them on the subcommand. `options` must outlive the parse.
void add_archive_options(CLI::App& app, ArchiveOptions& options);

struct ArchiveRequest {
    std::vector<std::string> stations;  // as typed; empty: those that reach the bounds
    std::optional<pipeline::Bounds> bounds;
    GridRequest place;
    bool spacing_given = false;
    bool place_given = false;  // a centre, a projection: a grid that is not the station's own
    std::optional<grid::Overlap> overlap;
    double overlap_length_m = 250'000;
};

// Errors: bad_argument, naming the option: also for one that goes without --catalog alone.
[[nodiscard]] Result<ArchiveRequest> parse_archive(const ArchiveOptions& options);

// The grid that holds the sites and 230 km about them, or the bounds. Without a spacing the least
// of 1, 2, 4 and 8 km by which no side has more than 1024 cells.
[[nodiscard]] Result<grid::GridSpec> archive_spec(const ArchiveRequest& request,
                                                  const std::vector<grid::SitePosition>& sites);

// "300", "90s", "5min", "1h"; bad_argument names the option.
[[nodiscard]] Result<std::chrono::seconds> parse_interval(const std::string& option,
                                                          const std::string& text);

}  // namespace stormcellar::cli
