// render/frame/probe.h -- what is at one place of a picture.
//
// Of a map: the value or the state of the column whose cell is drawn there. Of a volume: the column
// maximum over the ground there, not what a ray through the volume passes. Of a section: what is
// drawn at the pixel. With it the column's lowest and highest seen heights, the nearest column's in
// a section.
// Thread contract: pure functions.
#pragma once

#include <optional>
#include <string>

#include "stormcellar/base/result.h"
#include "stormcellar/grid/brick_view.h"
#include "stormcellar/grid/site_frame.h"
#include "stormcellar/render/render.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::render {

struct Probe {
    grid::GeoPoint place;  // of the point asked for
    grid::CellStatus status = grid::CellStatus::not_seen;
    float value = 0;        // where the status is value
    bool at_least = false;  // the true value may be larger
    std::string unit;
    std::optional<double> height_m;    // of the value: a maximum's, a CAPPI's, a section's point
    std::optional<double> distance_m;  // along a section
    std::optional<double> lowest_seen_m, highest_seen_m;  // none: the column was not seen
};

// A pixel of the whole picture, (0, 0) at its top left. bad_argument when it lies outside the
// picture, the grid or the section, or in the sky; and as render_frame().
[[nodiscard]] Result<Probe> probe_pixel(const grid::BrickView& view, const FrameFacts& facts,
                                        const Scene& scene, int x, int y, int threads);
// Of maps and volumes; bad_argument for a section and for places outside the grid.
[[nodiscard]] Result<Probe> probe_place(const grid::BrickView& view, const FrameFacts& facts,
                                        const Scene& scene, grid::GeoPoint place, int threads);

// "52.5 dBZ", "at least 12 km", "no echo".
[[nodiscard]] std::string probe_text(const Probe& probe);

}  // namespace stormcellar::render
