// render/products/product.h -- a scene's 2D product: its numbers, and what its picture says of it.
//
// Thread contract: pure functions.
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

// Of a map (is_map(scene.product)); the scene must be valid. bad_argument as the products.
[[nodiscard]] Result<FlatField> map_field(const grid::BrickView& view, const Scene& scene,
                                          const std::vector<ColumnSummary>& columns, int threads);

// "Reflectivity", "Correlation coefficient".
[[nodiscard]] std::string moment_title(level2::Moment moment);
// "Composite reflectivity (column maximum)".
[[nodiscard]] std::string product_title(const Scene& scene);

}  // namespace stormcellar::render
