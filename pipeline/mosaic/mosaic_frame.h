// pipeline/mosaic/mosaic_frame.h -- merges what several sites saw into one grid for an instant.
//
// Each volume is gridded once, on its site's window of the domain's grid. This is its partial,
// which the daemon stores in the cache and the command line in memory. A frame takes for each site
// the partials before and after the instant, makes a grid for the instant from them
// (grid/mosaic/time_interpolation.h), and merges the grids of all sites
// (stormcellar/grid/mosaic.h). The same partials and options give the same bytes, wherever they
// come from. If an earlier frame for the same instant has some of the same partials, only the
// bricks that the other partials touch are merged, and the rest is copied: the same bytes for less
// work. A frame is provisional while a site has nothing after the instant: a later volume will
// change it. Thread contract: pure functions, except for the caches of geometries, which many
// threads may share.
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

// How volumes become partials.
struct PartialOptions {
    grid::GridderOptions gridder;
    grid::Quantization quantization;
    grid::FrameKind frame = grid::FrameKind::table;
    double reach_m = grid::site_reach_m;
};

// Bricks of one volume on a domain's window of its site.
struct MadePartial {
    cache::GridDescription description;
    grid::BrickGrid bricks;
};
// None if the site does not reach the domain. The caller fills in the source files. Errors: those
// of make_grid().
[[nodiscard]] Result<std::optional<MadePartial>> make_partial(const level2::Volume& volume,
                                                              const grid::SitePosition& site,
                                                              const grid::GridSpec& domain,
                                                              const PartialOptions& options,
                                                              GeometryCache& geometries);

// A partial in a file or in memory; what it refers to must outlive its use.
struct PartialView {
    const cache::GridDescription* description = nullptr;
    grid::BrickView view;
    // The file of the view, which is verified before its cells are used. None: the partial is in
    // memory.
    const cache::GridFile* file = nullptr;

    [[nodiscard]] const grid::SitePosition& site() const { return description->sites.front(); }
    [[nodiscard]] UtcTime middle() const {
        return description->start_time + (description->end_time - description->start_time) / 2;
    }
};

// By ICAO; none if the motion of the echo is not known.
using Motions = std::map<std::string, std::optional<grid::MotionField>>;

struct FrameOptions {
    grid::MosaicOptions overlap;
    grid::TimeMethod time = grid::TimeMethod::advected;
    bool sweep_times = true;
    // A partial farther from the instant than this is not used: its site had a gap there.
    std::chrono::milliseconds greatest_gap = std::chrono::minutes{15};
    // Motions that were estimated before (estimate_motions()); a site without an entry does not
    // move. None: they are estimated from the partials. Must outlive the call.
    const Motions* motions = nullptr;
    int threads = 1;
};

// For one site: indices into the partials.
struct Bracket {
    std::optional<std::size_t> before, after;
};
// By ICAO. A site with neither partial is left out. Of partials with the same middle the last one
// counts.
[[nodiscard]] std::vector<Bracket> brackets_of(std::span<const PartialView> partials,
                                               UtcTime instant,
                                               std::chrono::milliseconds greatest_gap);

// For each site with a volume before the instant and one after it; only REF moves. Errors: those of
// grid::estimate_motion().
[[nodiscard]] Result<Motions> estimate_motions(std::span<const PartialView> partials,
                                               UtcTime instant, level2::Moment moment,
                                               const FrameOptions& options);

// Which partials make_frame() would use, as its provenance lists them, and by which rules: two
// frames with the same recipe have the same bytes. Errors: as make_frame(), except for those of
// cells, which are not read.
struct FrameRecipe {
    std::vector<grid::FramePart> parts;
    std::uint64_t recipe = 0;
};
[[nodiscard]] Result<FrameRecipe> recipe_for(const grid::GridSpec& domain,
                                             std::span<const PartialView> partials, UtcTime instant,
                                             const FrameOptions& options);

struct MosaicFrame {
    cache::GridDescription description;
    grid::Mosaic mosaic;
    // the windows whose bricks were merged; the rest was copied. None: all were merged
    std::optional<std::vector<grid::GridWindow>> merged;
};

class InstantCache;

// An earlier frame; its codes must have been verified.
struct PreviousFrame {
    const cache::GridDescription* description = nullptr;
    grid::BrickView cells;
};

// Earlier results that may be used; the frame has the same bytes without them.
struct MadeBefore {
    // Any frame; its parts tell what of it can be used (pipeline/mosaic/frame_parts.h).
    const PreviousFrame* frame = nullptr;
    InstantCache* instants =
        nullptr;  // sites' grids for instants (pipeline/mosaic/instant_cache.h)
};

// Errors: not_found if no site has a partial near the instant; the file of a partial that does not
// verify (its path begins the message); those of grid_at() and merge().
[[nodiscard]] Result<MosaicFrame> make_frame(const grid::GridSpec& domain,
                                             std::span<const PartialView> partials, UtcTime instant,
                                             const FrameOptions& options, GeometryCache& geometries,
                                             const MadeBefore& before = {});

}  // namespace stormcellar::pipeline
