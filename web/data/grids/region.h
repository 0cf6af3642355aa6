// web/data/grids/region.h -- a grid of several sites over a box that somebody draws, made on
// request.
//
// The grids of the sites that reach the box are laid on one plane about its middle, by their
// nearest columns (web/data/grids/nearest_columns.h). The mosaic's own code
// (pipeline/mosaic/mosaic_frame.h) then brings the sites to one instant, each from its volumes
// before and after with the motion of its echo, and merges them by the default rule of the moment.
// A box with too many columns is made of halved grids (web/data/grids/halved_grid.h, by maximum).
//
// Units     Degrees, meters.
// Threads   Pure functions of what the cache holds.
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
// Returns the box with its longitudes so: 170 to -170 and 170 to 190 are the same box, and so are
// 530 to 550. Longitudes that are equal stay so.
[[nodiscard]] RegionBox turned(RegionBox box);

// Limits of one request.
inline constexpr std::size_t most_region_columns = 1'000'000;
inline constexpr std::size_t most_region_sites = 32;
inline constexpr int most_region_halvings = 3;
// Instants of a region: whole multiples of this since midnight.
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
    std::vector<std::string> sites;     // that reach the box, by name
    std::vector<LeftOutSite> left_out;  // that stand in the box or reach it
    int halvings = 0;                   // of the sites' grids
};

// Returns the box of a text "west,south,east,north". Errors: bad_argument.
[[nodiscard]] Result<RegionBox> region_box_of(std::string_view text);

// Errors: bad_argument for a box that is none, that more than most_region_sites sites reach, or
// that is too large even for halved grids; not_found if no site with grids of the moment reaches
// it; those of Grids::find().
[[nodiscard]] Result<RegionPlan> plan_region(Grids& grids, const RegionBox& box,
                                             level2::Moment moment);

// Returns the instants for which one of the sites has a volume, and those between its volumes,
// rising.
[[nodiscard]] std::vector<UtcTime> region_times(const Grids& grids, const RegionPlan& plan);

// The volumes of a site before and after an instant. If one of them is null, the other is taken as
// it is.
struct RegionSite {
    std::string site;
    std::shared_ptr<const OpenGrid> before, after;
    std::string left_out_because;  // where there is neither
    // Returns the seconds from the instant to the middle of a volume; negative if it was before.
    [[nodiscard]] static double seconds_to(const OpenGrid& volume, UtcTime instant);
};
// Returns the sites of the plan with their volumes near the instant. Errors: those of
// Grids::find().
[[nodiscard]] Result<std::vector<RegionSite>> region_sites(Grids& grids, const RegionPlan& plan,
                                                           UtcTime instant);

// Makes the grid for an instant. A site whose grid of that time has other levels or codes than the
// plan is left out. Errors: not_found if no site has a volume near it that fits; those of
// Grids::find(), halved() and make_frame().
[[nodiscard]] Result<pipeline::MosaicFrame> make_region(Grids& grids, const RegionPlan& plan,
                                                        UtcTime instant);

}  // namespace stormcellar::web
