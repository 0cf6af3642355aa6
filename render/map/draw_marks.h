// render/map/draw_marks.h -- draws what render/map/map_marks.h has planned.
//
// Threads: pure functions but for the canvas.
#pragma once

#include "render/map/map_marks.h"

namespace stormcellar::render {

// Draws cities, distances and heights, with the map, before a volume.
void draw_ground_marks(Canvas& canvas, const Fonts& fonts, const MapLines& lines,
                       const MapMarks& marks);
// Draws sites, north arrow and scale bar, over everything.
void draw_marks(Canvas& canvas, const Fonts& fonts, const MapLines& lines, const MapMarks& marks);

}  // namespace stormcellar::render
