// grid/fill/sampled_columns.h -- fills the columns of a tile from one gate of each sweep.
//
// The first pass goes through the sweeps, and through all columns for each sweep, so that the
// tables and gates of a sweep stay in the processor's cache. A column leaves this pass when a beam
// is above its top level. The second pass fills each column (grid/fill/column.h).
//
// Threads   One object for each thread.
#pragma once

#include <span>
#include <vector>

#include "grid/fill/column.h"
#include "grid/fill/tile_columns.h"

namespace stormcellar::grid {

// The template parameters hold for all columns. They say whether each radial's own elevation
// counts, whether a cell takes the nearer beam, and whether the moment wraps.
template <bool radial_elevations, bool nearest, bool circular>
class SampledColumns {
  public:
    explicit SampledColumns(const FillWork& work) : work_(work) {}

    // Returns how far the samples for a tile's columns reach beyond the columns.
    [[nodiscard]] SampleReach reach_over(const Tile&) const { return work_.reach; }

    void fill(std::span<const PlannedSweep> plan, std::span<const TileColumn> columns);

  private:
    template <bool sampled>
    void look_at(const PlannedSweep& planned, std::span<const TileColumn> columns);

    const FillWork& work_;
    std::size_t most_beams_ = 0;
    std::vector<BeamSample> beams_;         // `most_beams_` places for each column
    std::vector<std::size_t> beam_counts_;  // of each column
    std::vector<std::size_t> open_;         // columns that no beam has passed above the top yet
};

}  // namespace stormcellar::grid
