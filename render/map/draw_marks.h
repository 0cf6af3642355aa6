// render/map/draw_marks.h -- draws the marks that render/map/map_marks.h has planned.
//
// Threads   Pure functions, except that they draw on the canvas.
#pragma once

#include "render/map/map_marks.h"

namespace stormcellar::render {

// Draws all marks on top of the picture. Their letters have a halo, so that echo does not hide
// them.
void draw_marks(Canvas& canvas, const Fonts& fonts, const MapLines& lines, const MapMarks& marks);

}  // namespace stormcellar::render
