// cli/grid/grid_notes.h -- what `stormcellar grid` and `accuracy` report on stderr although nothing
// failed.
//
// Each function returns a line without its line end, or none if there is nothing to report.
//
// Threads   Pure: may be called from any thread.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/shared/effect_options.h"
#include "stormcellar/grid/grid.h"

namespace stormcellar::cli {

// For a sounding that begins more than 500 m above the antenna: the air below it is a guess.
[[nodiscard]] std::optional<std::string> note_on_sounding(const EffectRequest& effects,
                                                          const grid::SitePosition& site);
// For a requested time more than an hour before the first or after the last radial used.
[[nodiscard]] std::optional<std::string> note_on_frame_time(const grid::Grid& grid);
// For a grid of which the radar sees no cell.
[[nodiscard]] std::optional<std::string> note_on_cells(const grid::Grid& grid);

// Returns all notes on a grid, including one on a profile that was given in vain.
[[nodiscard]] std::vector<std::string> notes_on(const grid::Grid& grid,
                                                const EffectRequest& effects);

}  // namespace stormcellar::cli
