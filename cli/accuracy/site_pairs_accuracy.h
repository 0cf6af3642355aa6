// cli/accuracy/site_pairs_accuracy.h -- `stormcellar accuracy A B... --compare-sites`: what sites
// that overlap say otherwise than each other (pipeline/mosaic/pair_comparison.h).
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
    UtcTime instant;  // the middle of what the newest volumes show
    std::vector<std::string> stations;
    std::vector<grid::SiteComparison> pairs;  // of those that may overlap, by their names
};

// Files of two sites or more; of a site with two volumes the motion of the weather is known, and
// with it clocks can be compared. Errors: bad_argument for another moment than REF or files of one
// site; those of load_mosaic() and pipeline::grid_volumes().
[[nodiscard]] Result<SitePairs> compare_site_files(const std::vector<std::string>& files,
                                                   const GridRequest& request,
                                                   const EffectRequest& effects);

// A table, and below it what was named and what could not be told.
[[nodiscard]] std::string format_site_pairs(const SitePairs& compared, bool markdown);
[[nodiscard]] nlohmann::ordered_json site_pairs_json(const SitePairs& compared);

// Compares and prints; the exit status.
int run_site_pairs(const GridOptions& options, const GridRequest& request,
                   const EffectRequest& effects, bool markdown);

}  // namespace stormcellar::cli
