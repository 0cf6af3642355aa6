// render/map/map_marks.h -- plans the marks on the map: sites, cities, the distances of rings,
// heights, north and a scale bar.
//
// Marks are planned first and drawn later, so that none overlaps another. The north arrow and the
// scale bar take the lower left corner, or another corner if a site is there. The key of beam
// glyphs takes a further corner. If every corner has a site, the arrow and the bar hide the site at
// the lower left. Then come the names of sites, heights, distances, and cities, the largest city
// first. If a name has no room, the name is left out, and with it the mark of a city, but not the
// mark of a site. Everything is inside the picture, and plans are in pixels of the picture.
//
// The length of the scale bar is true across the middle of the picture. The length is 1, 2 or 5
// times a power of ten, measured along WGS84 (to 1 % at worst). If the middle of the view shows no
// ground, there is no bar. Planning asks the view only for the places of points, and for the ground
// under pixels.
//
// Threads   Plain data; pure functions, except that they draw on the canvas.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/map/cell_marks.h"
#include "render/map/map_lines.h"
#include "render/map/mark_text.h"
#include "render/map/shape_marks.h"

namespace stormcellar::render {

struct ScaleBar {
    Point left;  // left end of the bar
    double length = 0;
    double metres = 0;
    Rect box;  // of bar and text
};

// A scale of heights. It is at an upright edge of the grid's box that has no echo behind it.
struct HeightScale {
    Point bottom, top;
    std::vector<Point> ticks;
    double side = -1;  // side of the ticks: -1 to the left
};

struct MapMarks {
    std::vector<Point> sites;
    std::vector<Point> cities;
    std::vector<MarkText> site_texts;
    std::vector<MarkText> ground_texts;  // distances and cities
    std::vector<MarkText> height_texts;
    std::optional<HeightScale> heights;
    Rect north;
    std::optional<ScaleBar> scale_bar;
    std::optional<Rect> glyph_key = {};  // render/map/beam_glyphs.h
    std::vector<CellMark> cells = {};    // the strongest first
    std::vector<ShapeMark> shapes = {};
};

[[nodiscard]] MapMarks plan_marks(const Fonts& fonts, const MapLines& lines);

}  // namespace stormcellar::render
