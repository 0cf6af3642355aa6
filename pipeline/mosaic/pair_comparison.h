// pipeline/mosaic/pair_comparison.h -- compares two sites of a mosaic where they overlap.
//
// The partial of a site holds what the site saw, unchanged. The age of each cell follows from the
// partial's sweeps (grid/sweep/sweep_clock.h). The motion of the weather follows from two volumes
// of a site, if there are two. With these, grid/judge/site_comparison.h compares the reflectivity
// that both sites saw at one instant. That header states the requirements and the accuracy.
//
// Cost      0.1 to 0.3 s for a pair of 1 km grids, and some 30 MiB.
// Threads   Pure functions.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "grid/judge/site_comparison.h"
#include "pipeline/mosaic/mosaic_frame.h"

namespace stormcellar::pipeline {

// A site's partial with the middle nearest to an instant, and the next nearest partial with the
// same columns (null: none).
struct SiteLook {
    const PartialView* nearest = nullptr;
    const PartialView* other = nullptr;

    [[nodiscard]] const grid::SitePosition& site() const { return nearest->site(); }
};
// Returns the looks of all sites, by ICAO. The partials must outlive the result.
[[nodiscard]] std::vector<SiteLook> looks_about(std::span<const PartialView> partials,
                                                UtcTime instant);

// Returns true if there is a place that is within the range of comparison of both sites.
[[nodiscard]] bool may_overlap(const grid::SitePosition& a, const grid::SitePosition& b);

// Returns the motion of the weather between two volumes of a site. Returns none if there is only
// one volume, or too little echo.
[[nodiscard]] std::optional<grid::UniformMotion> motion_between(const SiteLook& look);

// Compares two sites. Uses the motion around A and B together, as far as it is known. Errors:
// bad_argument for sites that cannot overlap, and for grids of other moments than REF; those of
// compare_sites().
[[nodiscard]] Result<grid::SiteComparison> compare_looks(const SiteLook& a, const SiteLook& b,
                                                         UtcTime instant);

// Returns a line such as "KB against KA: bias +0.12 +- 0.05 dB, azimuth ..., time not told (1234
// cells, correlation 0.93, looks 40 s apart)".
[[nodiscard]] std::string describe(const grid::SiteComparison& comparison);
// Returns true if at least one of the four faults could be estimated.
[[nodiscard]] bool tells_anything(const grid::SiteComparison& comparison);

}  // namespace stormcellar::pipeline
