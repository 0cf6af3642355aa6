// retrieve/cells/cell_columns.h -- measures echo top, VIL, hail and azimuthal shear of the columns
// of a storm cell.
//
// Units     As in stormcellar/retrieve/storm_cells.h.
// Threads   Pure functions.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "stormcellar/retrieve/hail.h"
#include "stormcellar/retrieve/storm_cells.h"
#include "stormcellar/retrieve/vertical_liquid.h"

namespace stormcellar::retrieve {

[[nodiscard]] inline bool is_seen(grid::CellStatus status) {
    return status == grid::CellStatus::value || status == grid::CellStatus::no_echo;
}

// Measures columns of one grid.
class ColumnMeter {
  public:
    // `hail` is absent if the freezing levels are unknown. The fields must outlive the meter.
    ColumnMeter(const CellFields& fields, std::optional<HailLayers> hail, float top_dbz);

    // Sets top, VIL, MESH with its range, and azimuthal shear of a cell from its columns.
    void measure(StormCell& cell);

  private:
    void read(int ix, int iy);
    void measure_top(StormCell& cell) const;
    [[nodiscard]] std::optional<float> greatest_shear(int ix, int iy) const;

    const CellFields& fields_;
    std::optional<HailLayers> hail_;
    float top_dbz_;
    LiquidColumn liquid_;
    std::vector<float> dbz_;  // of the column; NaN without a value
    std::vector<grid::CellStatus> seen_;
};

// Returns the thickness of each level's layer, which reaches half way to the next levels; the first
// and the last layer are symmetric about their levels. A single level has the thickness 0.
[[nodiscard]] std::vector<double> layer_thickness_m(std::span<const double> levels_m);

}  // namespace stormcellar::retrieve
