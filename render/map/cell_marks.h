// render/map/cell_marks.h -- plans and draws the marks of storm cells: a ring at the center, a
// label, the track behind and the forecast ahead.
//
// A solid line leads through the earlier places of the cell to its center. A dashed line leads on
// to the forecasts, with a tick at each and circles of the error (one standard deviation along each
// axis) after 30 and 60 minutes. A cell without motion has neither line. All of these are on the
// ground. In a volume, a stem leads up to the height of the largest reflectivity, where the label
// is. The label has the largest reflectivity and, if it is known, MESH.
//
// If the picture is later than the volume of the cells, as between two volumes or in a nowcast,
// each cell with a motion is moved on by its motion, and forecasts that are past are left out.
//
// Labels are planned from the strongest cell down, beside the line of motion if there is room, and
// never over another mark. A label without room has only the reflectivity, or is left out; the ring
// of its cell is drawn. Lines end where a perspective camera does not see them.
//
// Accuracy  Marks are at the places of the cells to 0.1 pixel of the map (cell_marks_test.cpp).
// Threads   Pure functions, except that they draw on the canvas and take places.
#pragma once

#include <optional>
#include <vector>

#include "render/map/map_lines.h"
#include "render/map/mark_text.h"

namespace stormcellar::render {

struct CellMark {
    Point center;              // on the ground
    std::optional<Point> top;  // in a volume: the center at the height of the maximum
    std::vector<Point> track;  // from the center back to the first sight
    std::vector<Point> ahead;  // from the center to the last forecast
    // Short lines across `ahead` at each forecast, as pairs of ends.
    std::vector<std::vector<Point>> ticks;
    std::vector<std::vector<Point>> errors;  // closed lines
    std::optional<MarkText> label;
};

// Plans the marks of `lines.cells`, the strongest first; no marks if `lines.cells` is null. `fonts`
// is null for a picture without labels. Takes the places of rings and labels.
[[nodiscard]] std::vector<CellMark> plan_cell_marks(const Fonts* fonts, const MapLines& lines,
                                                    LabelPlaces& places);

// Draws all but the labels.
void draw_cell_marks(Canvas& canvas, const std::vector<CellMark>& marks, const MapLines& lines);

}  // namespace stormcellar::render
