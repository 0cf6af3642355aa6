// render/frame/picture_layout.h -- lays out the whole picture: the picture of the grid, and the
// labels around it.
//
// Threads   Pure functions.
#pragma once

#include "render/map/labels.h"
#include "stormcellar/base/result.h"
#include "stormcellar/grid/brick_view.h"
#include "stormcellar/render/frame_facts.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::render {

// Returns the layout. Without labels, the picture of the grid is the whole picture. `coverage` only
// gives a line of text, and moves nothing. Errors: those of lay_out_labels() and of Fonts::load().
[[nodiscard]] Result<LabelLayout> layout_of(const grid::BrickView& view, const FrameFacts& facts,
                                            const Scene& scene,
                                            const std::optional<Coverage>& coverage = {});

}  // namespace stormcellar::render
