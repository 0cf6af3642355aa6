// render/frame/view_picture.h -- draws the picture of one grid with its map and its marks, but
// without the labels around it.
//
// Threads   Pure, except for the cache: one call at a time may use it. Each function uses `threads`
//           threads of its own.
#pragma once

#include <vector>

#include "render/frame/frame_cache.h"
#include "render/image/canvas.h"
#include "render/products/column_summary.h"
#include "stormcellar/base/result.h"
#include "stormcellar/grid/brick_view.h"
#include "stormcellar/render/frame_facts.h"
#include "stormcellar/render/image.h"
#include "stormcellar/render/overlays.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::render {

// The input of a picture: a grid, its facts, the scene, and the summaries of the columns.
struct DrawnView {
    const grid::BrickView& view;
    const FrameFacts& facts;
    const Scene& scene;
    const std::vector<ColumnSummary>& columns;
    Overlays overlays = {};
};

// The size of the picture, and of its lines and letters.
struct PictureSize {
    int width = 0, height = 0;
    double scale = 1;
};

// Draws a volume, a map or a section. check_frame() must accept the scene. `fonts` is null for a
// picture without labels, which has neither a map nor marks. Errors: those of render_frame().
[[nodiscard]] Result<Image> draw_view(const DrawnView& drawn, const PictureSize& size,
                                      const Fonts* fonts, int threads, FrameCache& cache);

// Draws the small map beside a section. It shows the composite of the grid and the line from A to
// B.
[[nodiscard]] Result<Image> draw_section_inset(const DrawnView& drawn, const PictureSize& size,
                                               const Fonts& fonts, int threads, FrameCache& cache);

}  // namespace stormcellar::render
