// pipeline/mosaic/pair_comparison.h -- compares two sites of a mosaic where they overlap.
//
// What each site saw is its partial. The age of each cell is recovered from the partial's sweeps
// (grid/sweep/sweep_clock.h), and the motion of the weather from two volumes of a site, if there
// are two. With these grid/judge/site_comparison.h compares what both sites saw at one instant; its
// header gives the assumptions and the accuracy. It compares reflectivity only. Cost: 0.1 to 0.3 s
// for a pair of 1 km grids, and some 30 MiB. Thread contract: pure functions.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "grid/judge/site_comparison.h"
#include "pipeline/mosaic/mosaic_frame.h"

namespace stormcellar::pipeline {

// For one site: the partial whose middle is nearest to an instant, and the next nearest on the same
// columns; null if there is no other.
struct SiteLook {
    const PartialView* nearest = nullptr;
    const PartialView* other = nullptr;

    [[nodiscard]] const grid::SitePosition& site() const { return nearest->site(); }
};
// By ICAO. The partials must outlive the result.
[[nodiscard]] std::vector<SiteLook> looks_about(std::span<const PartialView> partials,
                                                UtcTime instant);

// Returns true if any place is within the range of comparison of both.
[[nodiscard]] bool may_overlap(const grid::SitePosition& a, const grid::SitePosition& b);

// None if a site was seen only once, or too little echo is in both volumes.
[[nodiscard]] std::optional<grid::UniformMotion> motion_between(const SiteLook& look);

// The motion is that around A and B together, as far as it is known. Errors: bad_argument for sites
// that cannot overlap and for grids of other moments than REF; those of compare_sites().
[[nodiscard]] Result<grid::SiteComparison> compare_looks(const SiteLook& a, const SiteLook& b,
                                                         UtcTime instant);

// "KB against KA: bias +0.12 +- 0.05 dB, azimuth ..., time unknown (1234 cells, correlation 0.93,
// seen 40 s apart)". One line.
[[nodiscard]] std::string describe(const grid::SiteComparison& comparison);
// Returns true if any of the four could be determined.
[[nodiscard]] bool tells_anything(const grid::SiteComparison& comparison);

}  // namespace stormcellar::pipeline
