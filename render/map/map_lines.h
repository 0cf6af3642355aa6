// render/map/map_lines.h -- draws lines that place the volume: the border of the ground and range
// rings.
//
// The ViewGeometry of the picture projects everything. `left` and `top` are the place of that
// picture on the canvas. Range rings are on the ground, around a single site; a grid of several
// sites has marks but no rings. Points that the view does not project are not drawn.
//
// Accuracy  On an azimuthal equidistant map, a ring is drawn as a circle of the map. If its site is
//           not the center of the grid, the circle is off by less than 0.1 % of its radius, within
//           500 km of the center. On other maps a ring goes through 240 points at its distance.
//           Sites are exactly at their places on the map.
// Threads   Pure functions, except that they draw on the canvas.
#pragma once

#include <vector>

#include "render/image/canvas.h"
#include "render/map/map_layer.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/grid/grid.h"
#include "stormcellar/render/overlays.h"
#include "stormcellar/render/scene.h"
#include "stormcellar/render/view_geometry.h"

namespace stormcellar::render {

struct MapLines {
    const ViewGeometry* geometry = nullptr;
    const grid::GridSpec* spec = nullptr;
    const std::vector<grid::SitePosition>* sites = nullptr;
    const MapLayer* map = nullptr;       // cities to mark; null: none
    double ring_spacing_m = 50e3;        // as drawn, from drawn_ring_spacing()
    Units units;                         // units of written numbers
    Point glyph_key = {};                // width and height of the key of beam glyphs; 0: no key
    const CellOverlay* cells = nullptr;  // storm cells to mark; null: none
    const ShapeOverlay* shapes = nullptr;
    UtcTime time = {};     // of the picture
    bool heights = false;  // a scale of heights at the left edge of the box
    double scale = 1;      // of lines and text
    const Shades* shades = &shades::dark;
    double left = 0, top = 0;
};

// Returns the spacing of the rings. If the scene requests a spacing, it is rounded to a round
// number in the unit of distances (kilometers are not rounded), and then doubled until there are at
// most 20 rings. Otherwise (Scene::usual_rings) the spacing starts at 50 km and is doubled until at
// most six rings reach the nearest side of the grid; the spacing is less than 50 km if the grid is
// too small for one ring.
[[nodiscard]] double drawn_ring_spacing(const grid::GridSpec& spec, const Scene& scene);

// Draws a thin line around the ground of the grid.
void draw_border(Canvas& canvas, const MapLines& lines);
// Draws the rings. Call it before drawing a volume, but after drawing a 2D product.
void draw_rings(Canvas& canvas, const MapLines& lines);

// Returns the corners of the ground, for code that also draws marks (render/map/map_marks.h).
[[nodiscard]] std::vector<GroundPoint> ground_corners(const ViewGeometry& geometry);
[[nodiscard]] GroundPoint ground_of_site(const MapLines& lines, const grid::SitePosition& site);
// Returns the ring around a single site as a closed line, clockwise from north, in pixels of the
// picture.
[[nodiscard]] std::vector<Point> ring_points(const MapLines& lines, double radius_m);
// Restricts drawing to the picture.
void clip_to_picture(Canvas& canvas, const MapLines& lines);

}  // namespace stormcellar::render
