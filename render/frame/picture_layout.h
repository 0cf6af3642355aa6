// render/frame/picture_layout.h -- where the picture of the grid lies in the whole one, with its
// labels.
#pragma once

#include "render/map/labels.h"
#include "stormcellar/base/result.h"
#include "stormcellar/grid/brick_view.h"
#include "stormcellar/render/frame_facts.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::render {

// Without labels the picture is all. Errors: those of lay_out_labels() and of Fonts::load().
// `coverage` only fills a line of text: it moves nothing.
[[nodiscard]] Result<LabelLayout> layout_of(const grid::BrickView& view, const FrameFacts& facts,
                                            const Scene& scene,
                                            const std::optional<Coverage>& coverage = {});

}  // namespace stormcellar::render
