// grid/cells/level_range.h -- converts lengths in kilometers, as people write them, to meters.
//
// The command line and the daemon's configuration both use this parser, so that the same text gives
// the same grid, bit for bit.
//
// Threads   Pure functions.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace stormcellar::grid {

// Converts kilometers to meters. Rounds to the millimeter, so that 0.1 km is exactly 100 m.
[[nodiscard]] double metres_of_km(double km);

// Parses "bottom:top:step" in kilometers, and returns the levels in meters. The top is a level if
// the steps reach it (up to rounding). Returns none if the text has another form, the top is below
// the bottom, the step is not above 0, or there are more than GridSpec::greatest_level_count
// levels.
[[nodiscard]] std::optional<std::vector<double>> parse_level_range(std::string_view text);

}  // namespace stormcellar::grid
