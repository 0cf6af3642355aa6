// web/data/grids/halved_grid.h -- a grid with half the columns and rows, for looking at much of it.
//
// A cell of the halved grid stands for the four cells below it, on the same level (fewer at the
// edge of a grid with an odd number of columns or rows). Levels are never halved, so heights stay
// exact. Cells that are not seen do not count. Of the others, by
//   maximum  the largest value if there is one (of VEL, which has a sign, the value farthest from
//            0); else range folded if one is, so that such air never looks clear; else no echo
//   mean     range folded if most cells are; else no echo if there are more of those than values;
//            else the mean of the values, as they are stored (of REF in dBZ)
// A grid that is halved more than once is made of the one before, so `mean` is a mean of means.
//
// Threads   Pure functions.
// Errors    See halved().
// Accuracy  A mean is rounded to the next code: half a step each time.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include "stormcellar/base/result.h"
#include "stormcellar/grid/brick_grid.h"

namespace stormcellar::web {

enum class HalvedBy : std::uint32_t { maximum = 1, mean = 2 };  // numbers of the packed form
[[nodiscard]] std::optional<HalvedBy> halved_by_from_name(std::string_view name);
[[nodiscard]] std::string_view halved_by_name(HalvedBy by);

inline constexpr int most_halvings = 6;

// Returns the spec of a halved grid: the new cells lie over the old ones, so the offset may be
// other than a half.
[[nodiscard]] grid::GridSpec halved_spec(const grid::GridSpec& spec);

// Errors: bad_argument for `times` outside 1 to most_halvings, and for the mean of a moment whose
// values lie on a circle.
[[nodiscard]] Result<std::shared_ptr<const grid::BrickGrid>> halved(const grid::BrickView& view,
                                                                    level2::Moment moment,
                                                                    int times, HalvedBy by);

}  // namespace stormcellar::web
