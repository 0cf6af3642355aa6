// render/map/map_layer.h -- the base map as one picture shows it: projected, clipped, thinned.
//
// Made once for a grid's geometry, a view and a size; the frames of a loop share it.
// Every vertex is projected by itself; a segment, straight in degrees as its source has it, is
// divided until it follows its curve on the picture's ground to 0.2 pixels (where the view is
// finest). Lines end where the grid ends. Of three details the coarsest is taken that is thinned by
// at most 0.7 pixels; points less than 0.3 pixels from the one before go. Counties are shown where
// 45 km are 30 pixels and more (of a picture of 796 x 532). What the view does not project is not
// shown.
// Accuracy: 1.2 pixels against the built-in map at its finest (tests/render/map_layer_test.cpp);
// how good that is: docs/data-sources.md.
// Thread contract: a MapLayer is plain data; preparing is a pure function.
#pragma once

#include <string>
#include <vector>

#include "render/image/canvas.h"
#include "render/map/base_map.h"
#include "stormcellar/base/result.h"
#include "stormcellar/render/view_geometry.h"

namespace stormcellar::render {

struct MapStroke {
    MapKind kind = MapKind::coast;
    std::vector<Point> points;  // pixels of the picture, from its top left corner
};

struct MapPlace {
    Point at;
    std::string name;
};

struct MapLayer {
    std::vector<MapStroke> strokes;  // county, state, lake, country, coast
    std::vector<MapPlace> cities;    // inside grid and picture, the largest first
};

// `scale` is that of lines and text. corrupt when the map's lines contradict themselves.
[[nodiscard]] Result<MapLayer> prepare_map(const BaseMap& map, const grid::GridSpec& spec,
                                           const ViewGeometry& geometry, double scale);

// Keeps the map of the last picture: the frames of a loop need it made once.
// Thread contract: one thread at a time.
class MapCache {
  public:
    // Prepared anew where the grid's geometry, the view of the ground, the size or the scale is
    // another one than last time. Good until the next call.
    [[nodiscard]] Result<const MapLayer*> get(const grid::GridSpec& spec,
                                              const ViewGeometry& geometry, double scale);
    [[nodiscard]] int times_made() const { return times_made_; }

  private:
    grid::GridSpec spec_;
    std::vector<double> view_;  // where points of the ground are: tells one view from another
    MapLayer layer_;
    int times_made_ = 0;
};

// The lines, thin over a darker casing that parts them from echo. The cities are marks
// (render/map/map_marks.h).
void draw_map(Canvas& canvas, const MapLayer& layer, double scale, Point offset = {});

}  // namespace stormcellar::render
