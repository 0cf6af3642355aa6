// cli/picture/picture_ladder.h -- measures how the time and the error of a volume's picture depend
// on the choice (rung) for each step of its plan.
//
// The volume is gridded with the defaults of `stormcellar grid` and drawn with the defaults of
// `stormcellar frame`: 796 x 532 pixels, the default view, and the colors of the moment. Rows for
// light are measured on a picture with all kinds of light, other rows on a picture without light.
// The time of a row is the smallest of its rounds; each round makes everything anew.
#pragma once

#include <functional>
#include <vector>

#include "cli/grid/grid_request.h"
#include "cli/grid/volume_source.h"
#include "stormcellar/accuracy/ladder.h"
#include "stormcellar/base/result.h"

namespace stormcellar::cli {

// Measures the ladder. Calls `progress` with the number of finished parts and the number of all
// parts. Errors: those of gridding; not_found if the grid has no value.
[[nodiscard]] Result<std::vector<accuracy::LadderRow>> ladder_of_picture(
    const SourceVolume& source, const GridRequest& request, const grid::GridSpec& spec, int rounds,
    const std::function<void(std::size_t done, std::size_t total)>& progress);

}  // namespace stormcellar::cli
