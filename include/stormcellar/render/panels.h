// stormcellar/render/panels.h -- draws several views in one picture, with one title and one camera.
// Each view has its own map and legend.
//
// The views show one place and time, such as the moments of a volume. The panels have one size and
// are in rows, in the given order. The number of panels and the shape of the picture determine how
// many are in a row.
//
// Units     Pixels.
// Threads   Any thread may call; render_panels() uses `threads` threads of its own. A FrameCache
//           may be used by one call at a time.
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

// A grid with its facts and its scene. The first panel gives the title of the picture; its scene
// gives the size, the theme and whether there are labels.
struct Panel {
    grid::BrickView view;
    FrameFacts facts;
    Scene scene;
};

// Draws the panels. Errors: bad_argument if there are no panels or more than most_panels, if a
// panel is a section, or if the picture is too small for the panels; those of render_frame().
[[nodiscard]] Result<Image> render_panels(std::span<const Panel> panels, int threads,
                                          FrameCache* cache = nullptr);

}  // namespace stormcellar::render
