// render/map/map_lines.h -- lines that place the volume: border of the ground and range rings.
//
// Everything is projected by the ViewGeometry of the picture; `left` and `top` say where that
// picture lies on the canvas. Range rings stand on the ground round a single site; a grid of
// several sites has marks and no rings.
// Accuracy: on an azimuthal equidistant map a ring round a site that is not the grid's centre is
// drawn as a circle of the map, off by less than 0.1 % of its radius within 500 km of the centre;
// on the others it goes through 240 points at the ring's distance. Sites are where the map has
// them. What the view does not project is not drawn.
#pragma once

#include <vector>

#include "render/image/canvas.h"
#include "render/map/map_layer.h"
#include "stormcellar/grid/grid.h"
#include "stormcellar/render/view_geometry.h"

namespace stormcellar::render {

struct MapLines {
    const ViewGeometry* geometry = nullptr;
    const grid::GridSpec* spec = nullptr;
    const std::vector<grid::SitePosition>* sites = nullptr;
    const MapLayer* map = nullptr;  // its cities are marked; none: no cities
    double ring_spacing_m = 50e3;   // as drawn: by drawn_ring_spacing()
    bool heights = false;           // a scale of heights at the left edge of the box
    double scale = 1;               // of lines and text
    double left = 0, top = 0;
};

// The spacing asked for, doubled until there are at most 20 rings.
[[nodiscard]] double drawn_ring_spacing(const grid::GridSpec& spec, double asked_m);

// A thin line round the ground.
void draw_border(Canvas& canvas, const MapLines& lines);
// Drawn before a volume, after a 2D product.
void draw_rings(Canvas& canvas, const MapLines& lines);

// For what is drawn with the lines (render/map/map_marks.h).
[[nodiscard]] std::vector<GroundPoint> ground_corners(const ViewGeometry& geometry);
[[nodiscard]] GroundPoint ground_of_site(const MapLines& lines, const grid::SitePosition& site);
// The ring of a single site, clockwise from the north, closed; points in the picture's pixels.
[[nodiscard]] std::vector<Point> ring_points(const MapLines& lines, double radius_m);
// Restricts drawing to the picture.
void clip_to_picture(Canvas& canvas, const MapLines& lines);

}  // namespace stormcellar::render
