// cli/storms/cells_text.h -- storm cells as a table for people, and the formats for programs.
//
// Units     The table has km, m/s and mm; heights are above mean sea level.
// Threads   Pure functions.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "stormcellar/retrieve/storm_cells.h"

namespace stormcellar::cli {

// Returns a line with area and time, and a line for each cell, the strongest first.
[[nodiscard]] std::string cells_table(const retrieve::TrackedScan& scan);

// A text for other programs. This is the only list of formats.
struct CellFormat {
    std::string_view name;    // for --to
    std::string_view ending;  // of file names
    std::string (*text)(const retrieve::TrackedScan& scan);
};
[[nodiscard]] std::span<const CellFormat> cell_formats();

}  // namespace stormcellar::cli
