// cli/grid/grid_notes.h -- remarks of `stormcellar grid` and `accuracy` on stderr about work that
// succeeded.
//
// A note is a line without its line end. A function returns none if there is nothing to report.
//
// Threads   Pure: may be called from any thread.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/shared/effect_options.h"
#include "stormcellar/grid/grid.h"

namespace stormcellar::cli {

// Notes that a sounding begins more than 500 m above the antenna, so the air below it is a guess.
[[nodiscard]] std::optional<std::string> note_on_sounding(const EffectRequest& effects,
                                                          const grid::SitePosition& site);
// Notes that a requested time is more than an hour before the first or after the last radial used.
[[nodiscard]] std::optional<std::string> note_on_frame_time(const grid::Grid& grid);
// Notes that the radar sees no cell of the grid.
[[nodiscard]] std::optional<std::string> note_on_cells(const grid::Grid& grid);

// Returns all notes on a grid, including one on a profile that has no effect.
[[nodiscard]] std::vector<std::string> notes_on(const grid::Grid& grid,
                                                const EffectRequest& effects);

}  // namespace stormcellar::cli
