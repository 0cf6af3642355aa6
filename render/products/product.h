// render/products/product.h -- the 2D product of a scene: its numbers, and what its picture says
// about it.
//
// Threads   Pure functions.
#pragma once

#include <string>
#include <vector>

#include "render/products/column_summary.h"
#include "render/products/flat_field.h"
#include "stormcellar/base/result.h"
#include "stormcellar/grid/brick_view.h"
#include "stormcellar/render/image.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::render {

// Computes the product of a map (is_map(scene.product)). The scene must be valid. Errors:
// bad_argument, as for each product.
[[nodiscard]] Result<FlatField> map_field(const grid::BrickView& view, const Scene& scene,
                                          const std::vector<ColumnSummary>& columns, int threads);

// Returns a title such as "Reflectivity" or "Correlation coefficient".
[[nodiscard]] std::string moment_title(level2::Moment moment);
// Returns a title such as "Composite reflectivity (column maximum)".
[[nodiscard]] std::string product_title(const Scene& scene);

}  // namespace stormcellar::render
