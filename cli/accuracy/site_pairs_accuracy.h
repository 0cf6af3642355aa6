// cli/accuracy/site_pairs.h -- `stormcellar accuracy A B... --compare-sites`: how overlapping sites
// differ (pipeline/mosaic/pair_comparison.h).
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "cli/grid/grid_request.h"
#include "cli/shared/effect_options.h"
#include "grid/judge/site_comparison.h"
#include "stormcellar/base/result.h"

namespace stormcellar::cli {

struct SitePairs {
    UtcTime instant;  // the middle of the times that the newest volumes cover
    std::vector<std::string> stations;
    std::vector<grid::SiteComparison> pairs;  // those that may overlap, by their names
};

// Compares files of two sites or more. If a site has two volumes, the motion of the weather is
// known, so that clocks can be compared. Errors: bad_argument for another moment than REF or files
// of one site; those of load_mosaic() and grid_sources(). A bar shows the pairs where it is wanted.
[[nodiscard]] Result<SitePairs> compare_site_files(const std::vector<std::string>& files,
                                                   const GridRequest& request,
                                                   const EffectRequest& effects,
                                                   bool shows_progress);

// Returns a table, followed by the faults and what could not be determined.
[[nodiscard]] std::string format_site_pairs(const SitePairs& compared, bool markdown);
[[nodiscard]] nlohmann::ordered_json site_pairs_json(const SitePairs& compared);

// Compares and prints. Returns the exit status.
int run_site_pairs(const GridOptions& options, const GridRequest& request,
                   const EffectRequest& effects, bool markdown);

}  // namespace stormcellar::cli
