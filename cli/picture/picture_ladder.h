// cli/picture/picture_ladder.h -- measures what the accuracy of a picture of a volume costs in
// time.
//
// The volume is gridded as `stormcellar grid` does by default and drawn as `stormcellar frame`
// does: 796 x 532 pixels, the default view, the colors of the moment. Rows without light are of the
// picture without light; the rows of light are of a picture with all kinds of light. Times are the
// smallest of the rounds; each round makes everything anew.
#pragma once

#include <functional>
#include <vector>

#include "cli/grid/grid_request.h"
#include "cli/grid/volume_source.h"
#include "stormcellar/accuracy/ladder.h"
#include "stormcellar/base/result.h"

namespace stormcellar::cli {

// `progress` is told how many of how many parts are done. Errors: those of gridding; not_found if
// the grid holds no value at all.
[[nodiscard]] Result<std::vector<accuracy::LadderRow>> ladder_of_picture(
    const SourceVolume& source, const GridRequest& request, const grid::GridSpec& spec, int rounds,
    const std::function<void(std::size_t done, std::size_t total)>& progress);

}  // namespace stormcellar::cli
