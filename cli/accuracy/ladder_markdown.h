// cli/accuracy/ladder_markdown.h -- the ladder as a table of docs/accuracy.md: what that page shows
// is what `stormcellar accuracy --markdown` prints.
//
//   step | rung | time_s | position max / rms (m) | value rms / p95 / p99 / max (UNIT) |
//   status differs (%) | Pareto
// time_s is the time with kept geometry, or the first time where there is no other. Figures have
// three significant digits, rounded up, percentages two decimals; "-" where a row has none.
// Of pictures (cli/picture/picture_ladder.h): step | rung | time_s | colour p99 (dE) | Pareto.
// Threads: pure.
#pragma once

#include <span>
#include <string>

#include "stormcellar/accuracy/ladder.h"

namespace stormcellar::cli {

// Lines end with "\n"; no rows give the head alone.
[[nodiscard]] std::string ladder_markdown(std::span<const accuracy::LadderRow> rows,
                                          accuracy::ValueUnit unit);

}  // namespace stormcellar::cli
