// cli/picture/frame_sources.h -- gets the grid for `frame`: makes it from the named files, or takes
// a domain's newest grid from the cache.
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
#include "stormcellar/render/overlays.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::cli {

// The grid of a picture; for columns of rotation, the grid of azimuthal shear of the same time; and
// the storm cells to mark.
struct FrameGrids {
    std::optional<PictureGrid> shown, shear;
    std::optional<render::CellOverlay> cells;
};
// Returns the grid of the scene, and sets its domain in the options. If the cache has no such grid,
// reports that and returns none. Errors: bad_argument for words and options that do not fit each
// other; not_found if there is no shear, or no reflectivity for storm cells; those of PictureGrid's
// functions, find_cell_scans() and StoredCells::at().
[[nodiscard]] Result<FrameGrids> grid_of_frame(FrameOptions& options, const render::Scene& scene);
// Returns the grids of several moments at one time, in the order of the panels. If the cache does
// not have all of them, reports that and returns an empty list.
[[nodiscard]] Result<std::vector<PictureGrid>> grids_of_panels(
    FrameOptions& options, const std::vector<PanelScene>& panels);

}  // namespace stormcellar::cli
