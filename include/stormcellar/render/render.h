// stormcellar/render/render.h -- one grid and a scene -> one picture, with its labels.
//
// Draws the product (volume, map or section), then range rings, site marks, colour bar, title and
// time over it. The same input gives the same pixels for any number of threads.
#pragma once

#include "stormcellar/base/result.h"
#include "stormcellar/grid/brick_view.h"
#include "stormcellar/render/frame_facts.h"
#include "stormcellar/render/image.h"
#include "stormcellar/render/scene.h"
#include "stormcellar/render/view_geometry.h"

namespace stormcellar::render {

struct FrameKeeper;  // render/frame/frame_keeper.h

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
