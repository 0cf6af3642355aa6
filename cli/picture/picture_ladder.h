// cli/picture/picture_ladder.h -- measures how the time and the error of a volume's picture depend
// on the choice (rung) for each step of its plan.
//
// The volume is gridded with the defaults of `stormcellar grid` and drawn with the defaults of
// `stormcellar frame`: 796 x 532 pixels, the default view, the colors of the moment. The rows of
// light are for a picture with all kinds of light, the other rows for a picture without light.
// Times are the smallest of the rounds; each round makes everything anew.
#pragma once

#include <functional>
#include <vector>

#include "cli/grid/grid_request.h"
#include "cli/grid/volume_source.h"
#include "stormcellar/accuracy/ladder.h"
#include "stormcellar/base/result.h"

namespace stormcellar::cli {

// Measures the ladder. Calls `progress` with the number of parts done and of all parts. Errors:
// those of gridding; not_found if the grid has no value.
[[nodiscard]] Result<std::vector<accuracy::LadderRow>> ladder_of_picture(
    const SourceVolume& source, const GridRequest& request, const grid::GridSpec& spec, int rounds,
    const std::function<void(std::size_t done, std::size_t total)>& progress);

}  // namespace stormcellar::cli
