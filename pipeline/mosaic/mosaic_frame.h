// pipeline/mosaic/mosaic_frame.h -- merges the grids of several sites into one grid for an instant.
//
// Each volume is gridded once, on its site's window of the domain's grid. The result is called a
// partial; the daemon keeps it in the cache, and the command line in memory. For each site, a frame
// takes the partials before and after the instant and makes one grid of them for the instant
// (grid/mosaic/time_interpolation.h); then it merges the grids of all sites
// (stormcellar/grid/mosaic.h). The same partials and options give the same bytes, wherever they
// come from.
//
// If a frame for the same instant was made before, only the bricks that changed partials touch are
// merged, and the other bricks are copied, which gives the same bytes at lower cost. A frame is
// provisional while a site has no volume after the instant, because a later volume will change it.
//
// Threads   Functions without state, except for the caches, which many threads may share.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "grid/mosaic/motion.h"
#include "grid/mosaic/time_interpolation.h"
#include "pipeline/keep/geometry_cache.h"
#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/grid/gridder.h"
#include "stormcellar/grid/mosaic.h"

namespace stormcellar::pipeline {

// Options for making partials of volumes.
struct PartialOptions {
    grid::GridderOptions gridder;
    grid::Quantization quantization;
    grid::FrameKind frame = grid::FrameKind::table;
    double reach_m = grid::site_reach_m;
};

// The bricks of one volume on the domain's window of its site.
struct MadePartial {
    cache::GridDescription description;
    grid::BrickGrid bricks;
};
// Makes a partial. Returns none if the site does not reach the domain. The caller fills in the
// source files. Errors: those of make_grid().
[[nodiscard]] Result<std::optional<MadePartial>> make_partial(const level2::Volume& volume,
                                                              const grid::SitePosition& site,
                                                              const grid::GridSpec& domain,
                                                              const PartialOptions& options,
                                                              GeometryCache& geometries);

// A partial in memory or in a file. Its data must outlive the view.
struct PartialView {
    const cache::GridDescription* description = nullptr;
    grid::BrickView view;
    // The file of the view, which is verified before its cells are used. Null: the partial is in
    // memory.
    const cache::GridFile* file = nullptr;

    [[nodiscard]] const grid::SitePosition& site() const { return description->sites.front(); }
    [[nodiscard]] UtcTime middle() const {
        return description->start_time + (description->end_time - description->start_time) / 2;
    }
};

// The motion of the echo by ICAO; none: unknown.
using Motions = std::map<std::string, std::optional<grid::MotionField>>;

struct FrameOptions {
    grid::MosaicOptions overlap;
    grid::TimeMethod time = grid::TimeMethod::advected;
    bool sweep_times = true;
    // A partial whose middle is farther from the instant is not used.
    std::chrono::milliseconds greatest_gap = std::chrono::minutes{15};
    // The result of estimate_motions(), which must outlive the call; the echo of sites that it does
    // not have does not move. Null: motions are estimated from the partials.
    const Motions* motions = nullptr;
    int threads = 1;
};

// Indices into the partials, for one site.
struct Bracket {
    std::optional<std::size_t> before, after;
};
// Returns the brackets of all sites that have a partial within `greatest_gap` of the instant, by
// ICAO. If several partials of a site have the same middle, the last one counts.
[[nodiscard]] std::vector<Bracket> brackets_of(std::span<const PartialView> partials,
                                               UtcTime instant,
                                               std::chrono::milliseconds greatest_gap);

// Estimates the motion for each site that has a volume before the instant and one after it. Only
// REF moves. Errors: those of grid::estimate_motion().
[[nodiscard]] Result<Motions> estimate_motions(std::span<const PartialView> partials,
                                               UtcTime instant, level2::Moment moment,
                                               const FrameOptions& options);

// The partials from which make_frame() makes a frame, as its provenance lists them, and a hash of
// the rules. Frames with the same FrameRecipe are identical to the byte.
struct FrameRecipe {
    std::vector<grid::FramePart> parts;
    std::uint64_t recipe = 0;
};
// Returns the recipe of a frame without reading cells. Errors: those of make_frame(), except those
// of cells.
[[nodiscard]] Result<FrameRecipe> recipe_for(const grid::GridSpec& domain,
                                             std::span<const PartialView> partials, UtcTime instant,
                                             const FrameOptions& options);

// Returns the description that make_frame() gives the frame, without reading cells. Errors: those
// of recipe_for().
[[nodiscard]] Result<cache::GridDescription> describe_frame(const grid::GridSpec& domain,
                                                            std::span<const PartialView> partials,
                                                            UtcTime instant,
                                                            const FrameOptions& options);

struct MosaicFrame {
    cache::GridDescription description;
    grid::Mosaic mosaic;
    // The windows whose bricks were merged, if the other bricks were copied; none: all bricks were
    // merged.
    std::optional<std::vector<grid::GridWindow>> merged;
};

class InstantCache;

// A frame that was made before and whose codes were verified.
struct PreviousFrame {
    const cache::GridDescription* description = nullptr;
    grid::BrickView cells;
};

// Earlier results that may be reused, which save time and do not change the frame's bytes.
struct MadeBefore {
    // Any earlier frame; its parts (pipeline/mosaic/frame_parts.h) show how much of it can be
    // reused.
    const PreviousFrame* frame = nullptr;
    // The grids of sites for instants (pipeline/mosaic/instant_cache.h).
    InstantCache* instants = nullptr;
};

// Makes a frame. Errors: not_found if no site has a partial near the instant; the error of a
// partial's file that does not verify (its path begins the message); those of grid_at() and
// merge().
[[nodiscard]] Result<MosaicFrame> make_frame(const grid::GridSpec& domain,
                                             std::span<const PartialView> partials, UtcTime instant,
                                             const FrameOptions& options, GeometryCache& geometries,
                                             const MadeBefore& before = {});

}  // namespace stormcellar::pipeline
