// render/products/ground.h -- paints what lies flat: the ground of the 3D view, and 2D products.
//
// Both paint an opaque picture pixel by pixel. Each pixel shows the column into whose cell it
// falls; beyond the grid is the page.
//
// Threads   Pure functions; the same bits for any number of threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/products/column_summary.h"
#include "render/products/flat_field.h"
#include "stormcellar/grid/brick_view.h"
#include "stormcellar/render/colour_table.h"
#include "stormcellar/render/image.h"
#include "stormcellar/render/view_geometry.h"

namespace stormcellar::render {

// A column that was seen below this height above sea level counts as seen from low down.
inline constexpr double low_coverage_m = 3000;

// What the ground shows about the columns over it: whether they were seen from low down, only
// higher up, or not at all; or, if haze shows the rest, only whether they were seen.
enum class GroundTells { how_low, whether_seen };

[[nodiscard]] Image paint_ground(const grid::GridSpec& spec,
                                 const std::vector<ColumnSummary>& columns,
                                 const ViewGeometry& geometry, GroundTells tells, double scale,
                                 int threads);

// Returns the color of a place of a field at a pixel of the whole picture. A value has the color of
// the table, over plain ground where that is translucent, and with dots if it is "at least". No
// echo and values below the table are plain ground, range folded has its own color, and not seen is
// hatched.
[[nodiscard]] Rgba8 shade_of(const FlatField& field, std::size_t place, const ColourTable& table,
                             int x, int y, double scale);

// The same for a value or a state of no field.
[[nodiscard]] Rgba8 shade_of(grid::CellStatus status, float value, bool at_least,
                             const ColourTable& table, int x, int y, double scale);

// Paints a product, whose columns and rows are those of the grid; `smoothed` by
// render/products/smooth_field.h.
[[nodiscard]] Image paint_field(const grid::GridSpec& spec, const FlatField& field,
                                const ColourTable& table, const ViewGeometry& geometry,
                                double scale, int threads, bool smoothed = false);

// Returns the index of the column whose cell holds a point of the ground; -1 beyond the grid.
[[nodiscard]] std::ptrdiff_t column_at(const grid::GridSpec& spec, GroundPoint point);

}  // namespace stormcellar::render
