// render/still/plane_picture.h -- a 2D product drawn on a rectangle of a map's plane: on tiles and
// on pictures for maps of the web.
//
// A pixel shows the cell that holds its center, as overlay_color() colors it; outside of the grid
// it is clear. The field may be coarser than the grid: a cell of it then stands for 2^halvings by
// 2^halvings columns, from the southwest corner of the grid.
//
// Units     Web Mercator (EPSG:3857) in meters of its plane, degrees as longitude and latitude.
// Accuracy  Places between the corners of a mesh are straight. Where this is wrong by more than a
//           tenth of a pixel in the middle of a mesh or of a side, the mesh becomes finer.
// Threads   Pure functions.
// Errors    None: a window without a pixel, or one that does not meet the grid, gives clear pixels.
#pragma once

#include "render/products/flat_field.h"
#include "stormcellar/grid/grid_spec.h"
#include "stormcellar/render/color_table.h"
#include "stormcellar/render/image.h"

namespace stormcellar::render {

inline constexpr double mercator_radius_m = 6378137;
inline constexpr double mercator_edge_m = 20037508.342789244;  // radius times pi

enum class Plane { web_mercator, degrees };

// The edges of the outer pixels, in the unit of the plane.
struct PlaneWindow {
    Plane plane = Plane::web_mercator;
    double west = 0, south = 0, east = 0, north = 0;
    int width = 0, height = 0;  // pixels
};

// Where a grid is. Longitudes are continuous about that of its center, so that they may be beyond
// 180 degrees. About a pole it is all longitudes.
struct EarthBox {
    double south_deg = 0, north_deg = 0, west_deg = 0, east_deg = 0;
};
[[nodiscard]] EarthBox earth_box_of(const grid::GridSpec& spec);

// Latitude of a place in Web Mercator, and the inverse, for latitudes below 89.9 degrees.
[[nodiscard]] double mercator_latitude_deg(double y_m) noexcept;
[[nodiscard]] double mercator_y_m(double latitude_deg) noexcept;

// A product as it is drawn. What is referred to must outlive it.
struct PlaneMap {
    const grid::GridSpec& spec;
    const EarthBox& box;     // of the spec
    const FlatField& field;  // halved this often
    int halvings = 0;
    const ColorTable& table;
    bool smooth = false;  // values go smoothly from cell to cell (smooth_field.h)
};

// Returns false if no pixel of the window can lie on the grid.
[[nodiscard]] bool meets(const PlaneWindow& window, const EarthBox& box);
[[nodiscard]] Image draw_on_plane(const PlaneMap& map, const PlaneWindow& window);

}  // namespace stormcellar::render
