// grid/fill/sampled_columns.h -- fills the columns of a tile from one gate of each sweep.
//
// Sweep by sweep over all columns, as what a sweep needs then stays at hand; a column is done with
// when a beam passes above its top level. Then column by column (grid/fill/column.h).
// Threads: one object a thread.
#pragma once

#include <span>
#include <vector>

#include "grid/fill/column.h"
#include "grid/fill/tile_columns.h"

namespace stormcellar::grid {

// What is alike for all columns is known to the compiler: whether each radial's own elevation
// counts, whether a cell takes the nearer beam, and whether the moment wraps.
template <bool radial_elevations, bool nearest, bool circular>
class SampledColumns {
  public:
    explicit SampledColumns(const FillWork& work) : work_(work) {}

    // How far the samples of a tile's columns reach.
    [[nodiscard]] SampleReach reach_over(const Tile&) const { return work_.reach; }

    void fill(std::span<const PlannedSweep> plan, std::span<const TileColumn> columns);

  private:
    template <bool sampled>
    void look_at(const PlannedSweep& planned, std::span<const TileColumn> columns);

    const FillWork& work_;
    std::size_t most_beams_ = 0;
    std::vector<BeamSample> beams_;         // `most_beams_` places a column
    std::vector<std::size_t> beam_counts_;  // of each column
    std::vector<std::size_t> open_;         // columns that no beam has left through the top
};

}  // namespace stormcellar::grid
