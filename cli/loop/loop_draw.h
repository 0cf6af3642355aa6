// cli/loop/loop_draw.h -- draws one frame of a loop.
#pragma once

#include <optional>

#include "cli/loop/loop_grids.h"
#include "cli/loop/loop_options.h"
#include "cli/loop/loop_report.h"
#include "cli/picture/rotation_track.h"
#include "cli/picture/stored_cells.h"
#include "render/frame/frame_cache.h"
#include "stormcellar/base/result.h"
#include "stormcellar/cache/store.h"
#include "stormcellar/render/image.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::cli {

// State that the frames of a loop share.
struct Drawing {
    render::Scene scene;
    render::FrameCache cache;
    // The last grid that was made between volumes, and its time.
    std::optional<pipeline::MosaicFrame> made;
    UtcTime made_for{};
    RotationTrack track;                      // of the frames so far, for a product over time
    std::optional<StoredCells> cells;         // storm cells to mark
    std::optional<cache::StoreReader> store;  // has the grids of the radars of a mosaic
    bool lacks_hail = false;                  // of single radars; a note has said so
    std::optional<render::ShapeOverlay> shapes;
};

// Draws one frame. If its grid is damaged or cannot be made, returns none and adds the reason to
// the report. Errors: those of render_frame(); not_found if there is no reflectivity for storm
// cells.
[[nodiscard]] Result<std::optional<render::Image>> draw(
    const LoopFrame& frame, const LoopOptions& options,
    std::optional<pipeline::BetweenGrids>& between, Drawing& drawing, LoopReport& report);

}  // namespace stormcellar::cli
