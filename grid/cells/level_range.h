// grid/cells/level_range.h -- lengths as people write them, in kilometres, and as grids hold them.
//
// Options of the command line and keys of the daemon's configuration are read by the same code:
// what is written alike gives the same grid, bit for bit.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace stormcellar::grid {

// To the millimetre, so that 0.1 km is 100 m and nothing else.
[[nodiscard]] double metres_of_km(double km);

// "bottom:top:step" in kilometres -> levels in metres. A top that the steps reach but for rounding
// is reached. None when it is not of that form, the top is below the bottom, the step is not above
// 0, or the levels would be more than a grid has (GridSpec::greatest_level_count).
[[nodiscard]] std::optional<std::vector<double>> parse_level_range(std::string_view text);

}  // namespace stormcellar::grid
