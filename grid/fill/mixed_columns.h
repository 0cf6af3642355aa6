// grid/fill/mixed_columns.h -- fills the columns of a tile from several gates of each sweep, or as
// cells with an extent (grid/fill/mixed_column.h, grid/sweep/sweep_mixture.h).
//
// Threads   One object for each thread.
#pragma once

#include <span>
#include <vector>

#include "grid/fill/mixed_column.h"
#include "grid/fill/tile_columns.h"
#include "grid/place/footprint.h"

namespace stormcellar::grid {

class MixedColumns {
  public:
    explicit MixedColumns(const FillWork& work)
        : work_(work),
          mixed_(work.method.interpolation, work.stack.beam_width_deg, work.blending) {}

    // Returns how far the samples for a tile's columns reach beyond the columns.
    [[nodiscard]] SampleReach reach_over(const Tile& tile) const;
    void fill(std::span<const PlannedSweep> plan, std::span<const TileColumn> columns);

  private:
    void fill(std::span<const PlannedSweep> plan, const TileColumn& column);
    [[nodiscard]] BeamMixture beam_of(const PlannedSweep& planned, const TileColumn& column,
                                      const Footprint* footprint) const;
    [[nodiscard]] CellResult cell_at(std::size_t first, std::size_t count);

    const FillWork& work_;
    std::vector<BeamMixture> beams_;
    MixedColumn mixed_;
};

}  // namespace stormcellar::grid
