// stormcellar/grid/mosaic.h -- grids of many sites, each on a window of a domain's grid, merged
// into one.
//
// Each site is gridded once, on the domain's own columns (site_window(), window_spec()), and kept
// as bricks: its partial. Merging goes brick by brick and reads only bricks in which a site sees
// something; a new volume of one site costs the bricks that its window touches (update()).
//
// Of each cell only the sites that see it count. Each has a state and a weight by the arc r from
// its column to the site:
//   mean               weight 1
//   distance_weighted  exp(-r^2 / L^2) (Zhang, Howard and Gourley 2005; with L = 250 km Lakshmanan
//                      et al. 2006), never below 1e-30, so that the only site that sees a cell is
//                      not lost
//     both             states mix by the rule of docs/geometry.md: range folded where its weight is
//                      the largest, no echo where that outweighs values, else the weighted mean;
//                      for REF no echo enters it at its site's detection limit (by the curve of
//                      grid/beam/detection_limit.h at the slant range of the cell), else it does
//                      not
//   maximum            the largest value if any; else no echo if any site sees that; else folded
//   nearest            the state and value of the site with the smallest r that sees the cell; of
//                      two as near, the first by name. The only rule for VEL (velocities toward
//                      different radars) and PHI (each radar's own offset).
// Not seen is what no site sees. Of one site alone every cell is as its partial has it.
//
// Threads  pure functions; the result has the same bits for any number of threads and any order of
//          the partials (sums run in the order of ICAO, then position).
// Accuracy (enforced by tests/grid/mosaic_test.cpp, 1- and 2-byte codes)
//          a merged value is within 0.51 steps of the codes of the rule applied in exact arithmetic
//          to the values that the partials hold, unless it is below the least code (a mean with
//          detection limits) and takes that. The state is that of the exact rule, but where two
//          weights differ by less than 1e-5 of themselves. What partials were off by is not in it.
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
[[nodiscard]] std::string_view overlap_name(Overlap overlap);
[[nodiscard]] std::optional<Overlap> overlap_from_name(std::string_view name);
// The default for a moment: nearest where values of different sites are not to be mixed (VEL and
// PHI), else distance_weighted.
[[nodiscard]] Overlap default_overlap(level2::Moment moment);

struct MosaicOptions {
    level2::Moment moment = level2::Moment::ref;
    Overlap overlap = Overlap::distance_weighted;
    Averaging averaging = Averaging::in_db;  // in_z: reflectivity alone
    double length_m = 250000;                // L; 1 km to 10,000 km
    bool counts = false;                     // beside the values, see Mosaic
    bool weights = false;
    int threads = 1;
};

// What one site sees.
struct Partial {
    BrickView view;  // of a window of whole bricks; its spec and bytes must outlive the call
    SitePosition site;
    // Made before for this site, over a window that holds the view's; else it is made in the call.
    std::shared_ptr<const SiteDistance> distance = nullptr;
};

// The bricks of a mosaic, wherever they are. Where there are counts and weights, they have the same
// cells: a value where a site sees the cell, else not seen.
struct MosaicView {
    BrickView cells;
    std::optional<BrickView> counts;   // how many sites see the cell, exact up to 252
    std::optional<BrickView> weights;  // the sum of their weights; within 2^-11, up to 63
};

struct Mosaic {
    BrickGrid cells;
    std::optional<BrickGrid> counts;
    std::optional<BrickGrid> weights;
    [[nodiscard]] MosaicView view() const;  // valid as long as this lives and is not moved
};

// Partials of which the same window and quantisation may be asked; none at all gives a mosaic in
// which nothing is seen, in the moment's default quantisation.
// Errors: bad_argument for an invalid domain or options; a moment that the overlap or the averaging
// cannot mix; a partial that is no window of whole bricks of the domain, that is quantised unlike
// the others, or whose distance is of another place; one site twice.
[[nodiscard]] Result<Mosaic> merge(const GridSpec& domain, std::span<const Partial> partials,
                                   const MosaicOptions& options);

// The same bits as merge() of all partials, at the cost of the bricks within `changed`: the windows
// of every partial that came, went or was replaced since `previous` was made with the same options.
// All other bricks are copied from `previous`, and their partials are not read.
// Errors: those of merge(); bad_argument for a previous mosaic of another domain, quantisation or
// without the counts or weights asked for.
[[nodiscard]] Result<Mosaic> update(const MosaicView& previous, std::span<const Partial> partials,
                                    std::span<const GridWindow> changed,
                                    const MosaicOptions& options);

// The same bits again, but in `mosaic` itself: nothing is copied, so it costs the changed bricks
// and one pass over the table and states. Of `partials` only those are needed whose windows hold
// something changed; a mosaic too large for all of them at once is made of an empty one (merge() of
// no partials) stripe by stripe.
// Errors: those of update(), before anything was changed. No view of the mosaic may be in use.
[[nodiscard]] Status update_in_place(Mosaic& mosaic, std::span<const Partial> partials,
                                     std::span<const GridWindow> changed,
                                     const MosaicOptions& options);

}  // namespace stormcellar::grid
