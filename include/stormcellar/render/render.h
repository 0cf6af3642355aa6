// stormcellar/render/render.h -- draws one grid and a scene as one picture, with its labels.
//
// The product (volume, map or section) is drawn first; range rings, site marks, color bar, title
// and time are drawn over it. The same input gives the same pixels for any number of threads.
//
// Units     As in stormcellar/render/scene.h.
// Threads   Any thread may call; render_frame() uses `threads` threads of its own. A FrameCache
//           may be used by one call at a time.
// Errors    See each function.
#pragma once

#include "stormcellar/base/result.h"
#include "stormcellar/grid/brick_view.h"
#include "stormcellar/render/frame_facts.h"
#include "stormcellar/render/image.h"
#include "stormcellar/render/overlays.h"
#include "stormcellar/render/scene.h"
#include "stormcellar/render/view_geometry.h"

namespace stormcellar::render {

struct FrameCache;  // render/frame/frame_cache.h

// Draws a picture. If a loop passes the same cache for all its frames, the map and the colors are
// prepared only once and memory is allocated only once; the pixels are the same with or without a
// cache. A ppi needs a view of a sweep (BrickView::sweep), every other product a view of a grid.
// Errors: bad_argument if the view has another moment than the scene or is of the wrong kind, for
// heights beyond the grid, and for a section outside the grid; those of check_frame(). The columns
// of `overlays.rotation` (render/products/rotation.h) are drawn over a volume, because echo would
// hide them; storm cells are marked in maps and volumes.
[[nodiscard]] Result<Image> render_frame(const grid::BrickView& view, const FrameFacts& facts,
                                         const Scene& scene, int threads,
                                         FrameCache* cache = nullptr,
                                         const Overlays& overlays = {});

// Checks the requirements of render_frame() before anything is drawn. Also returns unsupported for
// a volume of more than 2^31 codes.
[[nodiscard]] Status check_frame(const grid::BrickView& view, const FrameFacts& facts,
                                 const Scene& scene);
// Returns the scene with the values that its view decides: for a ppi, the angle of the sweep.
[[nodiscard]] Scene scene_shown(const grid::BrickView& view, Scene scene);
// Returns the geometry of a volume or a map in a picture of this size. A map is seen from straight
// above, with north up.
[[nodiscard]] ViewGeometry picture_geometry(const grid::GridSpec& spec, const Scene& scene,
                                            int width, int height);

}  // namespace stormcellar::render
