// cli/accuracy/ladder_markdown.h -- prints a ladder: the time and the error of each choice (rung)
// for each step. `stormcellar accuracy --markdown` prints it, and docs/accuracy.md shows it.
//
// The columns are
//   step | rung | time_s | position max / rms (m) | value rms / p95 / p99 / max (UNIT) |
//   status differs (%) | Pareto
// time_s is the time of a grid whose geometry is kept, or of the first grid if only the first was
// timed. Figures have three significant digits, rounded up; percentages have two decimals; "-"
// marks a missing value. A ladder of pictures (cli/picture/picture_ladder.h) has the columns
//   step | rung | time_s | color p99 (dE) | Pareto
//
// Threads   Pure: may be called from any thread.
#pragma once

#include <span>
#include <string>

#include "stormcellar/accuracy/ladder.h"

namespace stormcellar::cli {

// Returns the table. Each line ends with a line feed. Without rows, the table is only the heading.
[[nodiscard]] std::string ladder_markdown(std::span<const accuracy::LadderRow> rows,
                                          accuracy::ValueUnit unit);

}  // namespace stormcellar::cli
