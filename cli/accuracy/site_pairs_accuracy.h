// cli/accuracy/site_pairs_accuracy.h -- `stormcellar accuracy A B... --compare-sites`: compares the
// echo of sites where they overlap (pipeline/mosaic/pair_comparison.h).
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
    UtcTime instant;  // --time, else pipeline::instant_of_newest()
    std::vector<std::string> stations;
    std::vector<grid::SiteComparison> pairs;  // the pairs of sites that may overlap, sorted by name
};

// Compares files of two or more sites. Clocks are compared only if a site of the pair has two
// volumes, because two volumes show the motion of the weather. With `shows_progress`, shows a
// progress bar for the pairs. Errors: bad_argument for another moment than REF or files of one
// site; those of load_mosaic() and grid_volumes().
[[nodiscard]] Result<SitePairs> compare_site_files(const std::vector<std::string>& files,
                                                   const GridRequest& request,
                                                   const EffectRequest& effects,
                                                   bool shows_progress);

// Returns a table, followed by the faults found and the quantities that could not be determined.
[[nodiscard]] std::string format_site_pairs(const SitePairs& compared, bool markdown);
[[nodiscard]] nlohmann::ordered_json site_pairs_json(const SitePairs& compared);

// Compares the sites, prints the results, and returns the exit status.
int run_site_pairs(const GridOptions& options, const GridRequest& request,
                   const EffectRequest& effects, bool markdown);

}  // namespace stormcellar::cli
