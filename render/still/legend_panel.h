// render/still/legend_panel.h -- draws a small panel that explains an overlay on a globe: product,
// place, time and colors.
//
// Threads   Pure.
// Errors    Those of Fonts::load().
#pragma once

#include "stormcellar/base/result.h"
#include "stormcellar/render/image.h"
#include "stormcellar/render/still.h"

namespace stormcellar::render {

[[nodiscard]] Result<Image> draw_legend_panel(const StillMap& map);

}  // namespace stormcellar::render
