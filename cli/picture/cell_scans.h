// cli/picture/cell_scans.h -- finds storm cells in grids of reflectivity that files give, and joins
// scans into the marks of a picture.
//
// Threads   One thread at a time.
// Errors    See each function.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cli/grid/grid_request.h"
#include "cli/picture/picture_grid.h"
#include "stormcellar/base/result.h"
#include "stormcellar/render/overlays.h"
#include "stormcellar/retrieve/storm_cells.h"

namespace stormcellar::cli {

struct CellInput {
    GridOptions grid;    // with the files
    bool shear = false;  // also derive azimuthal shear
    std::optional<retrieve::FreezingLevels> freezing;
};

struct CellScans {
    std::vector<retrieve::CellScan> scans;  // in order of time
    PictureGrid reflectivity;               // of the newest scan
    std::vector<std::string> newest_files;  // of the newest scan: one, or all of a mosaic
};

// Finds the cells of each file, after gridding Level II files. If the files are of several radars,
// one file of each, they make one mosaic. Each scan has the motion of its echo. Errors name the
// file: those of PictureGrid; bad_argument for several files of some radars but not of all, or for
// shear of a grid file.
[[nodiscard]] Result<CellScans> find_cell_scans(CellInput input);

// Finds the cells of a grid, with the motion of the echo since the grid `before` if that has the
// same cells. `shear` and `before` may be null. Errors: those of find_cells(), guess_motions() and
// check_whole().
[[nodiscard]] Result<retrieve::CellScan> scan_grid(
    const PictureGrid& reflectivity, const PictureGrid* shear, const PictureGrid* before,
    const std::string& area, const std::optional<retrieve::FreezingLevels>& freezing);

// Follows the cells through the scans, of which there is at least one. Errors: those of
// track_cells().
[[nodiscard]] Result<render::CellOverlay> overlay_of(std::span<const retrieve::CellScan> scans);

}  // namespace stormcellar::cli
