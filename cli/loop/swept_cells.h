// cli/loop/swept_cells.h -- the storm cells of the volumes from which a loop of sweeps is drawn.
//
// Cells are found in a grid of reflectivity of each volume, which is made for this purpose, and
// followed through the volumes of the last hour (StoredCells::history). Each volume is searched
// once.
//
// Threads   One thread at a time.
// Errors    See of().
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>

#include "cli/grid/grid_request.h"
#include "cli/picture/picture_grid.h"
#include "stormcellar/base/result.h"
#include "stormcellar/render/overlays.h"

namespace stormcellar::cli {

class SweptCells {
  public:
    // The options say how volumes are gridded.
    SweptCells(GridOptions options, std::optional<retrieve::FreezingLevels> freezing)
        : options_(std::move(options)), freezing_(freezing) {}

    // Returns the cells of a volume, followed through the volumes of earlier calls. `number` must
    // be larger for later volumes. Errors: those of PictureGrid::make() and scan_grid().
    [[nodiscard]] Result<render::CellOverlay> of(std::size_t number,
                                                 const std::filesystem::path& file);

  private:
    GridOptions options_;
    std::optional<retrieve::FreezingLevels> freezing_;
    std::map<std::size_t, retrieve::CellScan> scans_;
    std::optional<PictureGrid> newest_;  // of the last volume that was searched
};

}  // namespace stormcellar::cli
