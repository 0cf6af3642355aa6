// grid/fill/tile_plan.h -- which sweeps must be sampled over a tile, and which can be skipped.
//
// A sweep that is no echo, or not seen, all over a tile needs no sampling. If the sweeps around it
// have the same state, it changes no cell at all, because everything between two equal states has
// that state.
//
// Threads   One plan for each thread.
// Accuracy  Exact: a grid has the same bits as if every sweep were sampled in every column.
#pragma once

#include <span>
#include <vector>

#include "grid/sweep/polar_sweep.h"

namespace stormcellar::grid {

struct PlannedSweep {
    std::size_t index = 0;                     // index of the sweep
    bool sampled = true;                       // if false, the sweep has `status` all over the tile
    CellStatus status = CellStatus::not_seen;  // if it is not sampled
    bool adjacent_to_next = true;              // to the next sweep of the plan
};

// The reach of the samples of a column, and the number of sweeps up and down that make up a cell.
struct SampleReach {
    float azimuth_deg = 0;
    float arc_m = 0;
    int sweeps = 1;
    bool in_order = true;  // at every azimuth, sweeps are as high as their order says
};

class TilePlan {
  public:
    // Plans the sweeps of a tile. `adjacent_to_next` has one entry for each sweep. There is at
    // least one sweep.
    void make(std::span<const PolarSweep> sweeps, const std::vector<bool>& adjacent_to_next,
              const PolarBounds& bounds, const SampleReach& reach);
    // Returns at least one sweep, in rising order.
    [[nodiscard]] std::span<const PlannedSweep> sweeps() const { return planned_; }

  private:
    std::vector<PlannedSweep> planned_;
    std::vector<std::optional<CellStatus>> uniform_;
};

}  // namespace stormcellar::grid
