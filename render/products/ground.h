// render/products/ground.h -- what lies flat: the ground of the 3D view, and 2D products.
//
// Both paint an opaque picture pixel by pixel; each pixel shows the column whose cell it falls
// into. Beyond the grid is the page. The same bits for any number of threads.
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

// A column seen from below this height above sea level counts as seen from low down.
inline constexpr double low_coverage_m = 3000;

// What the ground tells of the columns over it: whether they were seen from low down, only higher
// up, or not; or only whether at all, where haze tells the rest.
enum class GroundTells { how_low, whether_seen };

[[nodiscard]] Image paint_ground(const grid::GridSpec& spec,
                                 const std::vector<ColumnSummary>& columns,
                                 const ViewGeometry& geometry, GroundTells tells, double scale,
                                 int threads);

// What a place of a field looks like at a pixel of the whole picture: a value by the table, over
// plain ground where the colour is translucent, dotted where it is "at least" so much; no echo and
// values below the table as plain ground, range folded in its colour, not seen hatched.
[[nodiscard]] Rgba8 shade_of(const FlatField& field, std::size_t place, const ColourTable& table,
                             int x, int y, double scale);

// A product of the grid, which has its columns and rows.
[[nodiscard]] Image paint_field(const grid::GridSpec& spec, const FlatField& field,
                                const ColourTable& table, const ViewGeometry& geometry,
                                double scale, int threads);

// The column whose cell holds a ground point, as an index; -1 beyond the grid.
[[nodiscard]] std::ptrdiff_t column_at(const grid::GridSpec& spec, GroundPoint point);

}  // namespace stormcellar::render
