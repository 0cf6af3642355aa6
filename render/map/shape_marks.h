// render/map/shape_marks.h -- plans and draws shapes from files that others made: lines and labeled
// points (stormcellar/render/overlays.h) that are in force at the time of the picture.
//
// Edges are straight in latitude and longitude, as RFC 7946 has it, and go the short way around the
// date line. They are on the ground. A line ends where the camera does not see it.
//
// Accuracy  Vertices are at their places to 0.1 pixel of the map; an edge is off by less than 0.2
//           pixel at the default size (shape_marks_test.cpp).
// Threads   Pure functions, except that they draw on the canvas and take places.
#pragma once

#include <optional>
#include <vector>

#include "render/map/map_lines.h"
#include "render/map/mark_text.h"

namespace stormcellar::render {

struct ShapeMark {
    std::vector<std::vector<Point>> lines;  // empty for a point
    std::optional<Point> dot;
    Rgba8 color{};
    double width = 2;  // at scale 1
    std::optional<MarkText> label;
};

// Plans the marks of `lines.shapes`, in their order; no marks if `lines.shapes` is null. `fonts` is
// null for a picture without labels. Takes the places of dots and labels; a label without room is
// left out.
[[nodiscard]] std::vector<ShapeMark> plan_shape_marks(const Fonts* fonts, const MapLines& lines,
                                                      LabelPlaces& places);

// Draws all but the labels. Lines and dots have a halo.
void draw_shape_marks(Canvas& canvas, const std::vector<ShapeMark>& marks, const MapLines& lines);

}  // namespace stormcellar::render
