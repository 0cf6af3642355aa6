// render/map/map_layer.h -- projects, clips and thins the base map for one picture.
//
// The layer is made once for the geometry of a grid, a view and a size, and the frames of a loop
// share it. Every vertex is projected exactly. In the source, a segment is straight in degrees. On
// the picture's ground it is a curve, so it is divided into straight pieces that are off by at most
// 0.2 pixels where the view is finest. Lines continue beyond the grid, as far as the ground is
// shown (render/products/ground.h). The layer uses the coarsest level of detail that is off by at
// most 0.7 pixels, or else the finest level. A point that is less than 0.3 pixels from the previous
// point is dropped. Points that the view cannot project are not shown.
//
// Accuracy  1.2 pixels against the built-in map at its finest (tests/render/map_layer_test.cpp).
//           For the accuracy of that map see docs/data-sources.md.
// Threads   A MapLayer is plain data. Preparing it is a pure function.
#pragma once

#include <string>
#include <vector>

#include "render/image/canvas.h"
#include "render/image/shades.h"
#include "render/map/base_map.h"
#include "render/products/water_mask.h"
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
    int population = 0;
};

struct MapLayer {
    std::vector<MapStroke> strokes;  // in the order of map_kinds
    std::vector<MapPlace> cities;    // inside the picture, the largest first
    WaterMask water;                 // over the ground that the picture shows
};

// Prepares the layer. `scale` is for lines and text. The layer does not depend on the number of
// threads. Errors: corrupt if the map's lines contradict themselves.
[[nodiscard]] Result<MapLayer> prepare_map(const BaseMap& map, const grid::GridSpec& spec,
                                           const ViewGeometry& geometry, double scale,
                                           int threads = 1);

// Keeps the map of the last picture, because all frames of a loop have the same map. One thread at
// a time may use a cache.
class MapCache {
  public:
    // Returns the layer. It is valid until the next call. A new layer is made if the geometry of
    // the grid, the view of the ground, the size or the scale differs from the last call.
    [[nodiscard]] Result<const MapLayer*> get(const grid::GridSpec& spec,
                                              const ViewGeometry& geometry, double scale,
                                              int threads = 1);
    [[nodiscard]] int times_made() const { return times_made_; }

  private:
    grid::GridSpec spec_;
    std::vector<double> view_;  // pictures of some ground points, which identify the view
    MapLayer layer_;
    int times_made_ = 0;
};

// Draws thin lines. A casing around them separates them from echo. Cities are drawn elsewhere, as
// marks (render/map/map_marks.h).
void draw_map(Canvas& canvas, const MapLayer& layer, const Shades& shades, double scale,
              Point offset = {});

}  // namespace stormcellar::render
