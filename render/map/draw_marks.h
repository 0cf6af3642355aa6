// render/map/draw_marks.h -- draws what render/map/map_marks.h has planned.
//
// Threads: pure functions but for the canvas.
#pragma once

#include "render/map/map_marks.h"

namespace stormcellar::render {

// Draws all marks, over everything. Letters have a halo, so that echo below does not hide them.
void draw_marks(Canvas& canvas, const Fonts& fonts, const MapLines& lines, const MapMarks& marks);

}  // namespace stormcellar::render
