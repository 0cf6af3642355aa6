// cli/picture/picture_ladder.h -- what the accuracy of a volume's picture costs in time.
//
// The volume is gridded as `stormcellar grid` does by default, and drawn as `stormcellar frame`
// does: 796 x 532 pixels, the default view, the moment's colours. Rows without light are those of
// the unlit picture; the rows of light are of one that asks for all kinds of it.
// Times are the least of the rounds, each with everything made anew.
#pragma once

#include <vector>

#include "cli/grid/grid_request.h"
#include "cli/grid/volume_source.h"
#include "stormcellar/accuracy/ladder.h"
#include "stormcellar/base/result.h"

namespace stormcellar::cli {

// Errors: those of gridding; not_found where the grid holds no value at all.
[[nodiscard]] Result<std::vector<accuracy::LadderRow>> ladder_of_picture(const SourceVolume& source,
                                                                         const GridRequest& request,
                                                                         const grid::GridSpec& spec,
                                                                         int rounds);

}  // namespace stormcellar::cli
