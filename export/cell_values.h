// export/cell_values.h -- the table of the values of a storm cell that its texts have in common.
//
// Threads   Pure functions.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "stormcellar/retrieve/storm_cells.h"

namespace stormcellar::cell_export {

// A number of a cell. The name ends with its unit.
struct CellValue {
    std::string_view name;
    int decimals = 0;
    std::optional<double> (*of)(const retrieve::TrackedCell& cell);  // none: unknown
};
[[nodiscard]] std::span<const CellValue> cell_values();

// Rounds to a number of decimals.
[[nodiscard]] double rounded(double value, int decimals);

inline constexpr int position_decimals = 5;

}  // namespace stormcellar::cell_export
