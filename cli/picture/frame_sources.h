// cli/picture/frame_sources.h -- which grid `frame` draws: one made of the files that its words
// name, or the newest of a domain of the cache.
//
// Threads   One thread at a time.
// Errors    See each function.
#pragma once

#include <optional>
#include <vector>

#include "cli/picture/frame_options.h"
#include "cli/picture/picture_grid.h"
#include "cli/picture/picture_panels.h"
#include "stormcellar/base/result.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::cli {

// Returns the grid of the scene, and leaves in the options which domain it is of. Returns none,
// after it was reported, if the cache has no such grid. Errors: bad_argument for words and options
// that do not fit each other, and those of PictureGrid's functions.
[[nodiscard]] Result<std::optional<PictureGrid>> grid_of_frame(FrameOptions& options,
                                                               const render::Scene& scene);
// The same for several moments of one time, in the order of the panels; returns no grid at all,
// after it was reported, if the cache has not all of them.
[[nodiscard]] Result<std::vector<PictureGrid>> grids_of_panels(
    FrameOptions& options, const std::vector<PanelScene>& panels);

}  // namespace stormcellar::cli
