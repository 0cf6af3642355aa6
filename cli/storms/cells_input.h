// cli/storms/cells_input.h -- the scans of storm cells that the files of a command line show.
//
// Threads   One thread at a time.
#pragma once

#include <optional>
#include <vector>

#include "cli/grid/grid_request.h"
#include "stormcellar/base/result.h"
#include "stormcellar/retrieve/storm_cells.h"

namespace stormcellar::cli {

struct CellInput {
    GridOptions grid;    // with the files
    bool shear = false;  // also derive azimuthal shear
    std::optional<retrieve::FreezingLevels> freezing;
};

// Finds the cells of each file: of a grid file, or of a Level II file that is gridded first. Files
// of several radars, one of each, make one mosaic. The scans are in order of time and know the
// motion of the echo. Errors name the file: those of PictureGrid; bad_argument for several files of
// some radars but not of all, or for shear of a grid file.
[[nodiscard]] Result<std::vector<retrieve::CellScan>> find_cell_scans(CellInput input);

}  // namespace stormcellar::cli
