// stormcellar/grid/mosaic.h -- merges grids of many sites, each on a window of a domain's grid,
// into one grid.
//
// Each site is gridded once, on columns of the domain (site_window(), window_spec()), and the grid
// is kept as bricks, which are called the site's partial. merge() goes brick by brick and reads
// only bricks in which a site sees something. After a new volume of one site, update() merges only
// the bricks that the site's window touches.
//
// In each cell only the sites that see it count. Each of these sites has a state, and a weight that
// depends on the arc r from the cell's column to the site:
//   mean               The weight is 1.
//   distance_weighted  The weight is exp(-r^2 / L^2) (Zhang, Howard and Gourley 2005; with L = 250
//                      km Lakshmanan et al. 2006). The weight is never below 1e-30, so that a cell
//                      seen only by one far site keeps its state.
//     both             States mix by the rule of docs/geometry.md. The cell is range folded if
//                      range folded has the largest weight, else no echo if no echo outweighs
//                      values, else the weighted mean of the values. For REF, a site that sees no
//                      echo enters the mean with its detection limit (the curve of
//                      grid/beam/detection_limit.h at the slant range of the cell). For other
//                      moments, such a site does not enter the mean.
//   maximum            The largest value if there is any; else no echo if any site sees no echo;
//                      else range folded.
//   nearest            The state and the value of the nearest site that sees the cell. If two sites
//                      are equally near, the first by name counts. Velocities, toward different
//                      radars, PHI, each radar's own offset, and HCA, classes without a mean, allow
//                      no other rule. AZSH also allows the maximum, in which ambiguous ranks
//                      between value and no echo.
// A cell that no site sees is not seen. With a single site, every cell is as in its partial.
//
// Units     Meters for distances; values are in the unit of the moment.
// Threads   Pure functions, except update_in_place(), which changes its mosaic. The result has the
//           same bits for any number of threads and any order of the partials (sums run in the
//           order of ICAO, then position).
// Errors    See each function.
// Accuracy  Enforced by tests/grid/mosaic_test.cpp with 1- and 2-byte codes. A merged value is
//           within 0.51 steps of the codes of the exact rule applied to the values in the partials.
//           If the exact result is below the least code (in a mean with detection limits), the
//           merged value is the least code. The state equals the exact rule's state, except where
//           two weights differ by less than 1e-5 of their size. The errors of the partials add to
//           this.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include "stormcellar/base/result.h"
#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/grid/grid_window.h"
#include "stormcellar/grid/method.h"
#include "stormcellar/grid/site_distance.h"

namespace stormcellar::grid {

enum class Overlap { mean, maximum, nearest, distance_weighted };
struct OverlapFacts {
    Overlap overlap = Overlap::mean;
    std::string_view name = {};
};
inline constexpr auto overlap_facts = std::to_array<OverlapFacts>({
    {Overlap::mean, "mean"},
    {Overlap::maximum, "maximum"},
    {Overlap::nearest, "nearest"},
    {Overlap::distance_weighted, "distance-weighted"},
});
// Returns "mean", "maximum", "nearest" or "distance-weighted".
[[nodiscard]] std::string_view overlap_name(Overlap overlap);
[[nodiscard]] std::optional<Overlap> overlap_from_name(std::string_view name);
// Returns the default for a moment: maximum for AZSH, nearest for other moments whose values must
// not be mixed between sites, else distance_weighted.
[[nodiscard]] Overlap default_overlap(level2::Moment moment);

struct MosaicOptions {
    level2::Moment moment = level2::Moment::ref;
    Overlap overlap = Overlap::distance_weighted;
    Averaging averaging = Averaging::in_db;  // in_z is for reflectivity only
    double length_m = 250000;                // L; 1 km to 10,000 km
    bool counts = false;                     // also make Mosaic::counts, Mosaic::weights
    bool weights = false;
    int threads = 1;
};

// The grid of one site, as an input of a mosaic.
struct Partial {
    BrickView view;  // a window of whole bricks; its spec and bytes must outlive the call
    SitePosition site;
    // The distances from this site, for a window that holds the window of the view. If null, the
    // call computes them.
    std::shared_ptr<const SiteDistance> distance = nullptr;
};

// The bricks of a mosaic, in memory or in a file. In counts and weights a cell has a value where a
// site sees it, and is not seen elsewhere.
struct MosaicView {
    BrickView cells;
    std::optional<BrickView> counts;   // the number of sites that see a cell, exact up to 252
    std::optional<BrickView> weights;  // the sum of the sites' weights, within 2^-11, up to 63
};

struct Mosaic {
    BrickGrid cells;
    std::optional<BrickGrid> counts;
    std::optional<BrickGrid> weights;
    [[nodiscard]] MosaicView view() const;  // valid as long as this object lives and is not moved
};

// Merges partials, which must all have the same quantization. Without partials, returns a mosaic in
// which nothing is seen, in the default quantization of the moment.
//
// Errors: bad_argument for an invalid domain or options; a moment that the overlap or the averaging
// cannot mix; a partial that is not a window of whole bricks of the domain, has another
// quantization, has distances for another place, or is not on the earth; the same site twice.
[[nodiscard]] Result<Mosaic> merge(const GridSpec& domain, std::span<const Partial> partials,
                                   const MosaicOptions& options);

// Returns the same bits as merge() of all partials, but merges only the bricks within `changed`:
// the windows of every partial that was added, removed or replaced since `previous` was made with
// the same options. All other bricks are copied from `previous`.
//
// Errors: the errors of merge(); bad_argument if `previous` is incomplete or lacks the counts or
// weights that the options ask for.
[[nodiscard]] Result<Mosaic> update(const MosaicView& previous, std::span<const Partial> partials,
                                    std::span<const GridWindow> changed,
                                    const MosaicOptions& options);

// Changes `mosaic` into the bits that update() would return. Copies nothing, so the call costs only
// the merging of the changed bricks and one pass over the table and the states. The call needs only
// the partials whose windows touch `changed`. A mosaic too large for all partials at once can be
// made stripe by stripe from an empty mosaic, which merge() returns if it gets no partials.
//
// No view of the mosaic may be in use. Errors: the errors of update(); the mosaic is then
// unchanged.
[[nodiscard]] Status update_in_place(Mosaic& mosaic, std::span<const Partial> partials,
                                     std::span<const GridWindow> changed,
                                     const MosaicOptions& options);

}  // namespace stormcellar::grid
