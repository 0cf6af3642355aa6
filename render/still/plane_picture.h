// render/still/plane_picture.h -- draws a 2D product on a rectangle of a map's plane, for tiles and
// pictures of web maps.
//
// A pixel shows the cell that holds its center, in the color that PlaneLook says. The field may be
// coarser than the grid: then each of its cells covers 2^halvings by 2^halvings columns, counted
// from the southwest corner of the grid.
//
// Units     Web Mercator (EPSG:3857) in meters of its plane, degrees as longitude and latitude.
// Accuracy  Places on the grid are interpolated between the corners of squares of pixels. A square
//           is divided if its middle, or the middle of a side, is off by more than a tenth of a
//           pixel.
// Threads   Pure functions.
// Errors    None: a window off the grid has the color of pixels outside the grid.
#pragma once

#include "render/products/flat_field.h"
#include "stormcellar/grid/grid_spec.h"
#include "stormcellar/grid/projection.h"
#include "stormcellar/grid/sweep_lookup.h"
#include "stormcellar/render/color_table.h"
#include "stormcellar/render/image.h"

namespace stormcellar::render {

inline constexpr double mercator_radius_m = 6378137;
inline constexpr double mercator_edge_m = 20037508.342789244;  // radius times pi

enum class Plane { web_mercator, degrees };

// The outer edges of the window, in the unit of the plane.
struct PlaneWindow {
    Plane plane = Plane::web_mercator;
    double west = 0, south = 0, east = 0, north = 0;
    int width = 0, height = 0;  // pixels
};

// The box of a grid on the earth. Longitudes are continuous about its center, so they may exceed
// 180 degrees either way. Around a pole, the box has all longitudes.
struct EarthBox {
    double south_deg = 0, north_deg = 0, west_deg = 0, east_deg = 0;
};
[[nodiscard]] EarthBox earth_box_of(const grid::GridSpec& spec);
// Returns true if the place is on a cell of the grid.
[[nodiscard]] inline bool is_on_grid(const grid::GridSpec& spec, grid::ColumnPoint at) {
    return at.x >= -0.5 && at.x < spec.nx - 0.5 && at.y >= -0.5 && at.y < spec.ny - 0.5;
}

// Convert between y and latitude in Web Mercator. mercator_y_m() is for latitudes below 89.9
// degrees.
[[nodiscard]] double mercator_latitude_deg(double y_m) noexcept;
[[nodiscard]] double mercator_y_m(double latitude_deg) noexcept;

// The way in which a pixel shows its cell.
enum class PlaneLook {
    overlay,  // in the color of overlay_color()
    echo,     // the same, but a cell that was not seen is transparent
    unseen,   // black if the cell was not seen, or if there is no cell; else transparent
};
// Returns the color of pixels outside the grid.
[[nodiscard]] Rgba8 color_outside(PlaneLook look);

// A product to draw. The referenced objects must outlive the PlaneMap.
struct PlaneMap {
    const grid::GridSpec& spec;
    const EarthBox& box;     // of the spec
    const FlatField& field;  // halved `halvings` times
    int halvings = 0;
    const ColorTable& table;
    bool smooth = false;  // values change smoothly from cell to cell (smooth_field.h)
    PlaneLook look = PlaneLook::overlay;
    // The sweep of the field, whose plane is `spec`. If the field is not halved, each pixel shows
    // the gate at its center. Null: the field is of a grid.
    const grid::SweepLookup* sweep = nullptr;
};

// Returns false if no pixel of the window can be on the grid.
[[nodiscard]] bool meets(const PlaneWindow& window, const EarthBox& box);
[[nodiscard]] Image draw_on_plane(const PlaneMap& map, const PlaneWindow& window);

}  // namespace stormcellar::render
