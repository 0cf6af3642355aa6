// pipeline/mosaic/pair_comparison.h -- two sites of a mosaic, compared where they overlap.
//
// What each saw is its partial, as it stands: the age of each cell is had back from the partial's
// sweeps (grid/sweep/sweep_clock.h), and the motion of the weather from two volumes of a site,
// where there are two. So grid/judge/site_comparison.h compares what both saw at one instant; what
// that takes and how exact it is stands there. Reflectivity alone. Cost     0.1 to 0.3 s a pair of
// 1 km grids, and some 30 MiB. Threads  pure functions.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "grid/judge/site_comparison.h"
#include "pipeline/mosaic/mosaic_frame.h"

namespace stormcellar::pipeline {

// Of one site: the partial whose middle is nearest to an instant, and the next nearest on the same
// columns; null where there is no other.
struct SiteLook {
    const PartialView* nearest = nullptr;
    const PartialView* other = nullptr;

    [[nodiscard]] const grid::SitePosition& site() const { return nearest->site(); }
};
// By ICAO. The partials must outlive what comes back.
[[nodiscard]] std::vector<SiteLook> looks_about(std::span<const PartialView> partials,
                                                UtcTime instant);

// Whether any place lies within the range of comparison of both.
[[nodiscard]] bool may_overlap(const grid::SitePosition& a, const grid::SitePosition& b);

// None where a site was seen once, or too little echo stands in both volumes.
[[nodiscard]] std::optional<grid::UniformMotion> motion_between(const SiteLook& look);

// The motion is that about A and B together, as far as it is known.
// Errors: bad_argument for sites that cannot overlap, for grids of other moments than REF, and
// those of compare_sites().
[[nodiscard]] Result<grid::SiteComparison> compare_looks(const SiteLook& a, const SiteLook& b,
                                                         UtcTime instant);

// "KB against KA: bias +0.12 +- 0.05 dB, azimuth ..., time not told (1234 cells, correlation 0.93,
// looks 40 s apart)". One line.
[[nodiscard]] std::string describe(const grid::SiteComparison& comparison);
// Whether any of the four could be told.
[[nodiscard]] bool tells_anything(const grid::SiteComparison& comparison);

}  // namespace stormcellar::pipeline
