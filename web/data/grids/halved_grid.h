// web/data/grids/halved_grid.h -- makes grids with half the columns and rows, to show large areas.
//
// A cell of the halved grid is made from the four cells that it covers on its level (fewer at the
// edge of a grid with an odd number of columns or rows). Levels are never halved, so heights stay
// exact. Cells that are not seen do not count; if none of the four is seen, the new cell is not
// seen. The seen cells become one by
//   maximum  the largest value, if there is one (for VEL, which has a sign, the value farthest
//            from 0); else range folded if one cell is, so that such air never looks clear;
//            else no echo
//   mean     range folded if more cells are range folded than have no echo, and more than have
//            values; else no echo if more cells have no echo than values; else the mean of the
//            values as they are stored (dBZ for REF)
// A grid that is halved twice is made from the halved grid, so its `mean` is a mean of means.
//
// Threads   Pure functions.
// Errors    See halved().
// Accuracy  Each halving rounds a mean to the nearest code. The error is at most half a step.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include "stormcellar/base/result.h"
#include "stormcellar/grid/brick_grid.h"

namespace stormcellar::web {

// The numbers are those of the packed form.
enum class HalvedBy : std::uint32_t { maximum = 1, mean = 2 };
[[nodiscard]] std::optional<HalvedBy> halved_by_from_name(std::string_view name);
[[nodiscard]] std::string_view halved_by_name(HalvedBy by);

inline constexpr int most_halvings = 6;

// Returns the spec of a halved grid. Each of its columns is in the middle of the columns that it
// covers, so the offset from the center may be any fraction of a cell.
[[nodiscard]] grid::GridSpec halved_spec(const grid::GridSpec& spec);

// Returns the grid halved `times` times. Errors: bad_argument for `times` outside 1 to
// most_halvings, and for the mean of a moment whose values are on a circle.
[[nodiscard]] Result<std::shared_ptr<const grid::BrickGrid>> halved(const grid::BrickView& view,
                                                                    level2::Moment moment,
                                                                    int times, HalvedBy by);

}  // namespace stormcellar::web
