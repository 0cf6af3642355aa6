// web/data/grids/region.h -- makes a grid from several sites, on request, for a box that a user has
// drawn.
//
// The plane of the grid is about the middle of the box. The grids of the sites that reach the box
// are resampled onto it by nearest columns (web/data/grids/nearest_columns.h). Then the code for
// mosaics (pipeline/mosaic/mosaic_frame.h) takes, for each site, the volumes just before and just
// after the instant, moves their echo to the instant, and merges the sites by the moment's default
// rule. If a box has too many columns, halved grids are used (web/data/grids/halved_grid.h, by
// maximum).
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

// West is within [-180, 180). East is greater than west; it is beyond 180 if the box crosses the
// antimeridian.
struct RegionBox {
    double west_deg = 0, south_deg = 0, east_deg = 0, north_deg = 0;
};
// Returns the same box with longitudes in these ranges. For example, 170 to -170 and 530 to 550
// become 170 to 190. Equal longitudes stay equal.
[[nodiscard]] RegionBox turned(RegionBox box);

// Limits of one request.
inline constexpr std::size_t most_region_columns = 1'000'000;
inline constexpr std::size_t most_region_sites = 32;
inline constexpr int most_region_halvings = 3;
// Regions have grids for instants that are whole multiples of this interval since midnight.
inline constexpr std::chrono::minutes region_interval{5};

// A site that a region's grid leaves out, with the reason.
struct LeftOutSite {
    std::string site, reason;
};

// Describes the grid of a region before it is made.
struct RegionPlan {
    level2::Moment moment = level2::Moment::ref;
    grid::GridSpec spec;
    grid::Quantization quantization;
    std::vector<std::string> sites;     // sites that reach the box, by name
    std::vector<LeftOutSite> left_out;  // sites in the box or in reach that have no fitting grids
    int halvings = 0;                   // how often each site's grid is halved
};

// Reads the box from a text "west,south,east,north". Errors: bad_argument.
[[nodiscard]] Result<RegionBox> region_box_of(std::string_view text);

// Plans the grid. Errors: bad_argument for an empty box, for a box that more than most_region_sites
// sites reach, and for a box that is too large even for halved grids; not_found if no site with
// grids of the moment reaches it; those of Grids::find().
[[nodiscard]] Result<RegionPlan> plan_region(Grids& grids, const RegionBox& box,
                                             level2::Moment moment);

// Returns the instants for which a grid can be made, in ascending order. These are the instants
// nearest to the start of a site's volume, and the instants between two volumes that are close
// enough to move the echo.
[[nodiscard]] std::vector<UtcTime> region_times(const Grids& grids, const RegionPlan& plan);

// The volumes of a site before and after an instant. If only one volume is set, its echo is not
// moved.
struct RegionSite {
    std::string site;
    std::shared_ptr<const OpenGrid> before, after;
    std::string left_out_because;  // set if both are null
    // Returns the seconds from the instant to the middle of a volume; negative if the middle is
    // earlier.
    [[nodiscard]] static double seconds_to(const OpenGrid& volume, UtcTime instant);
};
// Returns the sites of the plan with their volumes near the instant. Errors: those of
// Grids::find().
[[nodiscard]] Result<std::vector<RegionSite>> region_sites(Grids& grids, const RegionPlan& plan,
                                                           UtcTime instant);

// Makes the grid for an instant. Leaves out a site whose grid at that time has other levels or
// codes than the plan. Errors: not_found if no site has a fitting volume near the instant; those of
// Grids::find(), halved() and make_frame().
[[nodiscard]] Result<pipeline::MosaicFrame> make_region(Grids& grids, const RegionPlan& plan,
                                                        UtcTime instant);

}  // namespace stormcellar::web
