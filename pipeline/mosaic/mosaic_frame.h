// pipeline/mosaic/mosaic_frame.h -- merges the grids of several sites into one grid for an instant.
//
// Each volume is gridded once, on the window of the domain's grid that its site may see. The result
// is called a partial; the daemon keeps it in the cache, and the command line in memory. To make a
// frame, the partials before and after the instant are made into one grid for the instant, for each
// site (grid/mosaic/time_interpolation.h). Then the grids of all sites are merged
// (stormcellar/grid/mosaic.h). The same partials and options always give the same bytes.
//
// If a frame for the same instant was made before, only the bricks that changed partials touch are
// merged, and the other bricks are copied. This gives the same bytes in less time. A frame is
// provisional while one of its sites has no volume after the instant, because a later volume will
// change it.
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

// Options for making a partial of a volume.
struct PartialOptions {
    grid::GridderOptions gridder;
    grid::Quantization quantization;
    grid::FrameKind frame = grid::FrameKind::table;
    double reach_m = grid::site_reach_m;
};

// The bricks of one volume on the window of its site.
struct MadePartial {
    cache::GridDescription description;
    grid::BrickGrid bricks;
};
// Makes a partial. Returns none if the site does not reach the domain. The caller must add the
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
    // The file in which the cells are. It is verified before its cells are used. Null: the partial
    // is in memory.
    const cache::GridFile* file = nullptr;

    [[nodiscard]] const grid::SitePosition& site() const { return description->sites.front(); }
    [[nodiscard]] UtcTime middle() const {
        return description->start_time + (description->end_time - description->start_time) / 2;
    }
};

// The motion of the echo at each site, by ICAO; none: it is unknown.
using Motions = std::map<std::string, std::optional<grid::MotionField>>;

struct FrameOptions {
    grid::MosaicOptions overlap;
    grid::TimeMethod time = grid::TimeMethod::advected;
    bool sweep_times = true;
    // A partial whose middle is farther from the instant is not used.
    std::chrono::milliseconds greatest_gap = std::chrono::minutes{15};
    // The result of estimate_motions(). It must outlive the call. At a site that is not in this
    // result, echo does not move. Null: motions are estimated from the partials.
    const Motions* motions = nullptr;
    int threads = 1;
};

// The partials of one site before and after the instant, as indices.
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

// The partials from which make_frame() makes a frame, as the frame's provenance lists them, and a
// hash of the rules. Frames with the same FrameRecipe have the same bytes.
struct FrameRecipe {
    std::vector<grid::FramePart> parts;
    std::uint64_t recipe = 0;
};
// Returns the recipe of a frame, without reading cells. Errors: those of make_frame() that do not
// come from cells.
[[nodiscard]] Result<FrameRecipe> recipe_for(const grid::GridSpec& domain,
                                             std::span<const PartialView> partials, UtcTime instant,
                                             const FrameOptions& options);

// Returns the description that make_frame() gives to the frame, without reading cells. Errors:
// those of recipe_for().
[[nodiscard]] Result<cache::GridDescription> describe_frame(const grid::GridSpec& domain,
                                                            std::span<const PartialView> partials,
                                                            UtcTime instant,
                                                            const FrameOptions& options);

struct MosaicFrame {
    cache::GridDescription description;
    grid::Mosaic mosaic;
    // The windows whose bricks were merged; the other bricks were copied. None: all bricks were
    // merged.
    std::optional<std::vector<grid::GridWindow>> merged;
};

class InstantCache;

// A frame that was made before and whose codes were verified.
struct PreviousFrame {
    const cache::GridDescription* description = nullptr;
    grid::BrickView cells;
};

// Earlier results that may be reused. They save time and do not change the bytes of the frame.
struct MadeBefore {
    // Any earlier frame. Its parts (pipeline/mosaic/frame_parts.h) show how much of it can be
    // reused.
    const PreviousFrame* frame = nullptr;
    // Grids of single sites for an instant (pipeline/mosaic/instant_cache.h).
    InstantCache* instants = nullptr;
};

// Makes a frame. Errors: not_found if no site has a partial near the instant; if the file of a
// partial does not verify, that error, with the file's path at the start of the message; those of
// grid_at() and merge().
[[nodiscard]] Result<MosaicFrame> make_frame(const grid::GridSpec& domain,
                                             std::span<const PartialView> partials, UtcTime instant,
                                             const FrameOptions& options, GeometryCache& geometries,
                                             const MadeBefore& before = {});

}  // namespace stormcellar::pipeline
