// cli/grid/grid_notes.h -- remarks that `stormcellar grid` and `accuracy` print on stderr when the
// work succeeded but the user may have wanted something else.
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

// Returns a note if a sounding begins more than 500 m above the antenna, because the air below it
// is then a guess.
[[nodiscard]] std::optional<std::string> note_on_sounding(const EffectRequest& effects,
                                                          const grid::SitePosition& site);
// Returns a note if the requested time is more than an hour before the first radial used, or after
// the last.
[[nodiscard]] std::optional<std::string> note_on_frame_time(const grid::Grid& grid);
// Returns a note if the radar sees no cell of the grid.
[[nodiscard]] std::optional<std::string> note_on_cells(const grid::Grid& grid);

// Returns all notes on a grid, including one on a profile that has no effect.
[[nodiscard]] std::vector<std::string> notes_on(const grid::Grid& grid,
                                                const EffectRequest& effects);

}  // namespace stormcellar::cli
