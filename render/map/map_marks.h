// render/map/map_marks.h -- what stands on the map and where: sites, cities, the rings' distances,
// heights, north and a scale bar.
//
// Planned first and drawn later (render/map/draw_marks.h), so that nothing stands on anything else:
// the north arrow and the scale bar have a corner, the lower left one unless a site is there; then
// come names of sites, heights, distances and cities, the largest first. A name that has no room is
// left out; a site's mark is drawn all the same, a city's is not. All lies inside the picture;
// plans are in its pixels. The scale bar holds at the middle of the picture, across it: 1, 2 or 5
// times a power of ten, by the distance on WGS84 (1 % of it at worst). None where the view's middle
// shows no ground. Needs of the view only where points are and which ground is under a pixel.
// Thread contract: pure functions and plain data.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/map/map_lines.h"

namespace stormcellar::render {

struct MarkText {
    Rect box;  // the text lies inside
    Point left_baseline;
    double size = 0;
    bool bold = false;
    Rgba8 colour{};
    std::string text;
};

struct ScaleBar {
    Point left;  // its left end
    double length = 0;
    double metres = 0;
    Rect box;  // of bar and text
};

// A scale of heights, at an edge of the box behind which there is nothing.
struct HeightScale {
    Point bottom, top;
    std::vector<Point> ticks;
    double side = -1;  // of the ticks: -1 to the left
};

struct MapMarks {
    std::vector<Point> sites;
    std::vector<Point> cities;
    std::vector<MarkText> site_texts;    // over everything
    std::vector<MarkText> ground_texts;  // distances and cities: under a volume
    std::vector<MarkText> height_texts;
    std::optional<HeightScale> heights;
    Rect north;
    std::optional<ScaleBar> scale_bar;
};

[[nodiscard]] MapMarks plan_marks(const Fonts& fonts, const MapLines& lines);

// "50 km", "200 m".
[[nodiscard]] std::string distance_text(double metres);

}  // namespace stormcellar::render
