// stormcellar/render/panels.h -- several views in one picture: one title, one camera, and for each
// view a map and a legend of its own.
//
// The views are those of one place and time, such as the moments of a volume. The panels have one
// size and stand in rows, in the order that is given; how many stand in a row follows from the size
// of the picture.
//
// Units     Pixels.
// Threads   Any thread may call; render_panels() uses `threads` threads of its own. A FrameCache
// may
//           be used by one call at a time.
// Errors    See render_panels().
#pragma once

#include <cstddef>
#include <span>

#include "stormcellar/base/result.h"
#include "stormcellar/grid/brick_view.h"
#include "stormcellar/render/frame_facts.h"
#include "stormcellar/render/image.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::render {

struct FrameCache;  // render/frame/frame_cache.h

inline constexpr std::size_t most_panels = 9;

// A grid, and how it is to be seen. The title is that of the first panel; the size of the picture,
// its theme and whether it has labels are those of the first scene.
struct Panel {
    grid::BrickView view;
    FrameFacts facts;
    Scene scene;
};

// Draws the panels. Errors: bad_argument if there are none or more than most_panels, for a section,
// and for a picture that is too small for them; those of render_frame().
[[nodiscard]] Result<Image> render_panels(std::span<const Panel> panels, int threads,
                                          FrameCache* cache = nullptr);

}  // namespace stormcellar::render
