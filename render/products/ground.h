// render/products/ground.h -- what lies flat: the ground of the 3D view, and the column maximum.
//
// Both paint an opaque picture pixel by pixel; each pixel shows the column whose cell it falls
// into. Beyond the grid is the page. The same bits for any number of threads.
#pragma once

#include <cstdint>
#include <vector>

#include "grid/brick_view.h"
#include "render/colour/colour_table.h"
#include "render/image.h"
#include "render/products/column_summary.h"
#include "render/view_geometry.h"

namespace stormcellar::render {

// A column seen from below this height above sea level counts as seen from low down.
inline constexpr double low_coverage_m = 3000;

// Ground that tells how the columns over it were seen: from low down, only higher up, or not.
[[nodiscard]] Image paint_ground(const grid::GridSpec& spec,
                                 const std::vector<ColumnSummary>& columns,
                                 const ViewGeometry& geometry, double scale, int threads);

// The column maximum by the colour table; no echo and values below the table as plain ground,
// range folded in its colour, columns not seen hatched.
[[nodiscard]] Image paint_composite(const grid::BrickView& view, const ColourTable& table,
                                    const std::vector<ColumnSummary>& columns,
                                    const ViewGeometry& geometry, double scale, int threads);

}  // namespace stormcellar::render
