// render/products/ground.h -- paints pictures without depth: the ground of the 3D view, and 2D
// products.
//
// Both are opaque pictures, painted pixel by pixel. Each pixel shows the column that contains it.
// If the picture has a map, the ground continues beyond the grid, darker (lighter on a light page).
// Without a map, the page is seen beyond the grid. Land and water have shades of their own.
//
// Threads   Pure functions; the same bits for any number of threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/image/shades.h"
#include "render/products/column_summary.h"
#include "render/products/flat_field.h"
#include "render/products/water_mask.h"
#include "stormcellar/grid/brick_view.h"
#include "stormcellar/render/color_table.h"
#include "stormcellar/render/image.h"
#include "stormcellar/render/view_geometry.h"

namespace stormcellar::render {

// A column that was seen below this height above sea level counts as seen from low down.
inline constexpr double low_coverage_m = 3000;

// The shades of the ground tell how the columns over it were seen. how_low has three shades: seen
// from low down, seen only from higher up, and not seen. whether_seen, for pictures with haze, has
// two: seen and not seen.
enum class GroundTells { how_low, whether_seen };

// The settings for painting the ground.
struct GroundLook {
    const Shades* shades = &shades::dark;
    const WaterMask* water = nullptr;  // null: all is land, and there is nothing beyond the grid
    double scale = 1;                  // of hatch and dots
};

// A pixel of the whole picture, and the ground under it.
struct GroundPatch {
    int x = 0, y = 0;
    double water = 0;  // share of water
    GroundPoint point{};

    [[nodiscard]] Rgba8 shade(const GroundLook& look, Rgba8 GroundShades::*which) const {
        return mixed(look.shades->land.*which, look.shades->water.*which, water);
    }
    [[nodiscard]] Rgba8 unseen(const GroundLook& look) const {
        return hatched(shade(look, &GroundShades::not_seen), look.shades->hatch, x, y, look.scale);
    }
};

[[nodiscard]] Image paint_ground(const grid::GridSpec& spec,
                                 const std::vector<ColumnSummary>& columns,
                                 const ViewGeometry& geometry, GroundTells tells,
                                 const GroundLook& look, int threads);

// Returns the color of a place of a field at a pixel of the whole picture. A value has its color in
// the table, over plain ground if the color is translucent, and with dots if the value is an "at
// least" value. No echo and values below the table are plain ground. Range folded has a color of
// its own, and ambiguous is plain ground hatched in that color. Not seen is hatched in the theme's
// color.
[[nodiscard]] Rgba8 shade_of(const FlatField& field, std::size_t place, const ColorTable& table,
                             const GroundPatch& patch, const GroundLook& look);

// Returns the color of a value or a state that is not in a field.
[[nodiscard]] Rgba8 shade_of(grid::CellStatus status, float value, bool at_least,
                             const ColorTable& table, const GroundPatch& patch,
                             const GroundLook& look);

// Paints a field with the columns and rows of the grid, smoothed (render/products/smooth_field.h)
// if `smoothed` is true.
[[nodiscard]] Image paint_field(const grid::GridSpec& spec, const FlatField& field,
                                const ColorTable& table, const ViewGeometry& geometry,
                                const GroundLook& look, int threads, bool smoothed = false);

// Returns true if parallel rays look straight down, as in a map.
[[nodiscard]] bool is_from_above(const ViewGeometry& geometry);
// Returns how far beyond the grid the ground is shown, in meters. If seen from straight above, the
// ground fills the picture; otherwise it ends a little outside the grid.
[[nodiscard]] double reach_beyond_m(const ViewGeometry& geometry);
// Fades the ground beyond the grid, and the lines on it, to the page. Does nothing if the camera
// looks straight down.
void fade_beyond(const ViewGeometry& geometry, const Shades& shades, int threads, Image& picture);
// Paints a field that has a place for each pixel (sweep_in_picture()).
[[nodiscard]] Image paint_pixels(const grid::GridSpec& spec, const FlatField& field,
                                 const ColorTable& table, const ViewGeometry& geometry,
                                 const GroundLook& look, int threads);

// Returns the index of the column whose cell holds a point of the ground; -1 beyond the grid.
[[nodiscard]] std::ptrdiff_t column_at(const grid::GridSpec& spec, GroundPoint point);

}  // namespace stormcellar::render
