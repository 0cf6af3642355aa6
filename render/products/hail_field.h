// render/products/hail_field.h -- maps of hail, and the error of the largest hail if the heights of
// 0 and -20 C err (stormcellar/retrieve/hail.h).
//
// A column has a value if echo of more than 40 dBZ reaches above 0 C. The value is marked "at
// least" if a cell next to such echo, above 0 C, was not seen or is range folded. Other columns
// have the states of other products of reflectivity (flat_field.h); echo that makes no hail counts
// as no echo.
//
// Method    Only bricks whose largest value makes hail are read. The flux of each code is computed
//           once.
// Units     Heights above mean sea level, in meters; values as in retrieve::Hail.
// Accuracy  Equal to retrieve::hail_of_column() of the cells (tests/render/hail_field_test.cpp).
//           Codes of 0.5 dBZ change MESH by up to 0.3 mm (KTLX, 1999-05-03).
// Threads   Pure functions; the same bits for any number of threads.
#pragma once

#include <optional>
#include <vector>

#include "render/products/column_summary.h"
#include "render/products/flat_field.h"
#include "stormcellar/base/result.h"
#include "stormcellar/grid/brick_view.h"
#include "stormcellar/retrieve/hail.h"

namespace stormcellar::render {

// Makes the map of one number of hail. `radar_m` is the height of the radar, which only the
// probability needs. `columns` are the summaries of the grid's columns. Errors: those of
// retrieve::hail_layers(), as for a grid of one level.
[[nodiscard]] Result<FlatField> hail_field(const grid::BrickView& view,
                                           float retrieve::Hail::*number,
                                           const retrieve::FreezingLevels& levels, double radar_m,
                                           const std::vector<ColumnSummary>& columns, int threads);

struct LargestHail {
    float mesh_mm = 0;
    retrieve::MeshRange range;  // of the same column, if the heights err by usual_level_error_m
};
// Finds the column with the largest MESH. Returns none if there is no hail. Errors: as
// hail_field().
[[nodiscard]] Result<std::optional<LargestHail>> largest_hail(
    const grid::BrickView& view, const retrieve::FreezingLevels& levels, int threads);

}  // namespace stormcellar::render
