// cli/grid/grid_notes.h -- what `stormcellar grid` and `accuracy` say on stderr though nothing
// failed.
//
// Each gives a line without its end, or none where there is nothing to say. Threads: pure.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/shared/effect_options.h"
#include "stormcellar/grid/grid.h"

namespace stormcellar::cli {

// The air between the antenna and a sounding that begins more than 500 m above it is a guess.
[[nodiscard]] std::optional<std::string> note_on_sounding(const EffectRequest& effects,
                                                          const grid::SitePosition& site);
// The time asked for lies more than an hour before the first or after the last radial used.
[[nodiscard]] std::optional<std::string> note_on_frame_time(const grid::Grid& grid);
// The radar sees no cell.
[[nodiscard]] std::optional<std::string> note_on_cells(const grid::Grid& grid);

// All that there is to say of a grid, that a profile was given in vain included.
[[nodiscard]] std::vector<std::string> notes_on(const grid::Grid& grid,
                                                const EffectRequest& effects);

}  // namespace stormcellar::cli
