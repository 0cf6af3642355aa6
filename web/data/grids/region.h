// web/data/grids/region.h -- makes a grid from several sites, on request, over a box that a user
// draws.
//
// The grids of the sites that reach the box are resampled by nearest columns onto one plane about
// its middle (web/data/grids/nearest_columns.h). The mosaic's code (pipeline/mosaic/mosaic_frame.h)
// then takes, for each site, the volumes just before and just after the instant, moves their echo
// to the instant, and merges the sites by the moment's default rule. A box with too many columns is
// made from halved grids (web/data/grids/halved_grid.h, by maximum).
//
// Units     Degrees, meters.
// Threads   Functions without state, which read the cache.
// Errors    See each function.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/mosaic/mosaic_frame.h"
#include "stormcellar/base/result.h"
#include "stormcellar/grid/grid_spec.h"
#include "web/data/grids/grids.h"

namespace stormcellar::web {

// West is within [-180, 180); east is greater, and beyond 180 if the box crosses the antimeridian.
struct RegionBox {
    double west_deg = 0, south_deg = 0, east_deg = 0, north_deg = 0;
};
// Returns the box with its longitudes in these ranges: 170 to -170 and 170 to 190 are the same box,
// and so are 530 to 550. Equal longitudes stay equal.
[[nodiscard]] RegionBox turned(RegionBox box);

// Limits of one request.
inline constexpr std::size_t most_region_columns = 1'000'000;
inline constexpr std::size_t most_region_sites = 32;
inline constexpr int most_region_halvings = 3;
// A region has grids for instants that are whole multiples of this interval after midnight.
inline constexpr std::chrono::minutes region_interval{5};

// A site that the grid of a region leaves out, and why.
struct LeftOutSite {
    std::string site, reason;
};

// Describes the grid of a region before it is made.
struct RegionPlan {
    level2::Moment moment = level2::Moment::ref;
    grid::GridSpec spec;
    grid::Quantization quantization;
    std::vector<std::string> sites;     // sites that reach the box, by name
    std::vector<LeftOutSite> left_out;  // sites in the box or in reach, without fitting grids
    int halvings = 0;                   // of each site's grid
};

// Reads the box from a text "west,south,east,north". Errors: bad_argument.
[[nodiscard]] Result<RegionBox> region_box_of(std::string_view text);

// Plans the grid. Errors: bad_argument for an empty box, for a box that more than most_region_sites
// sites reach, and for a box too large even for halved grids; not_found if no site with grids of
// the moment reaches it; those of Grids::find().
[[nodiscard]] Result<RegionPlan> plan_region(Grids& grids, const RegionBox& box,
                                             level2::Moment moment);

// Returns, in ascending order, the instants nearest to the start of a site's volume, and the
// instants between two volumes that are close enough to move the site.
[[nodiscard]] std::vector<UtcTime> region_times(const Grids& grids, const RegionPlan& plan);

// The volumes of a site before and after an instant. If one volume is null, the echo of the other
// volume is not moved.
struct RegionSite {
    std::string site;
    std::shared_ptr<const OpenGrid> before, after;
    std::string left_out_because;  // set if both are null
    // Returns the seconds from the instant to the middle of a volume; negative if it was before.
    [[nodiscard]] static double seconds_to(const OpenGrid& volume, UtcTime instant);
};
// Returns the sites of the plan with their volumes near the instant. Errors: those of
// Grids::find().
[[nodiscard]] Result<std::vector<RegionSite>> region_sites(Grids& grids, const RegionPlan& plan,
                                                           UtcTime instant);

// Makes the grid for an instant. A site whose grid of that time has other levels or codes than the
// plan is left out. Errors: not_found if no site has a fitting volume near the instant; those of
// Grids::find(), halved() and make_frame().
[[nodiscard]] Result<pipeline::MosaicFrame> make_region(Grids& grids, const RegionPlan& plan,
                                                        UtcTime instant);

}  // namespace stormcellar::web
