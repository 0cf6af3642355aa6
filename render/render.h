// render/render.h -- one grid and a scene -> one picture, with its labels.
//
// Draws the product (volume, map or section), then range rings, site marks, colour bar, title and
// time over it. The same input gives the same pixels for any number of threads.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "base/utc_time.h"
#include "grid/brick_view.h"
#include "render/image.h"
#include "render/scene.h"
#include "render/view_geometry.h"

namespace stormcellar::render {

struct FrameKeeper;  // render/frame_keeper.h

// What the labels say about the grid.
struct FrameFacts {
    std::string domain;
    level2::Moment moment = level2::Moment::ref;
    UtcTime time;
    std::vector<grid::SitePosition> sites;
    bool partial = false;
    // The rest may be left empty. The time where somebody is, "1999-05-03 18:56:21 CDT".
    std::string local_time = {};
    // From the newest radial to now, of a picture made while it is news.
    std::optional<std::chrono::seconds> antenna_to_picture = {};
    // What radars say is wrong with them, "KTLX: standby, maintenance required".
    std::vector<std::string> radar_troubles = {};
    bool interpolated = false;  // between volumes, as it was called for
};

// A loop hands the same keeper to each of its frames: map and colours are then prepared once, and
// room is taken once. The pixels are the same with it or without.
// bad_argument when the grid's moment is not the scene's, and for heights beyond the grid's,
// or a section outside it.
[[nodiscard]] Result<Image> render_frame(const grid::BrickView& view, const FrameFacts& facts,
                                         const Scene& scene, int threads,
                                         FrameKeeper* keeper = nullptr);

// What render_frame() asks of them before it draws; unsupported for a volume of more than 2^31
// codes.
[[nodiscard]] Status check_frame(const grid::BrickView& view, const FrameFacts& facts,
                                 const Scene& scene);
// How a volume or a map is seen in a picture of this size; a map straight down with north up.
[[nodiscard]] ViewGeometry picture_geometry(const grid::GridSpec& spec, const Scene& scene,
                                            int width, int height);

}  // namespace stormcellar::render
