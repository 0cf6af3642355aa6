// grid/fill/tile_plan.h -- decides which sweeps must be sampled over a tile.
//
// If a sweep has a single status (no echo or not seen) all over a tile, it need not be sampled
// there. If the sweeps around it have the same status, the sweep can be dropped, because the cells
// between equal states have that state anyway.
//
// Threads   One plan for each thread.
// Accuracy  Exact: the grid has the same bits as if every sweep were sampled in every column.
#pragma once

#include <span>
#include <vector>

#include "grid/sweep/polar_sweep.h"

namespace stormcellar::grid {

struct PlannedSweep {
    std::size_t index = 0;                     // index of the sweep
    bool sampled = true;                       // false: `status` holds all over the tile
    CellStatus status = CellStatus::not_seen;  // meaningful only if not sampled
    bool adjacent_to_next = true;              // no lost cut is between this and the next sweep
};

// The reach of samples beyond a column, and the number of sweeps above and below from which a cell
// may take values.
struct SampleReach {
    float azimuth_deg = 0;
    float arc_m = 0;
    int sweeps = 1;
    bool in_order = true;  // true if sweeps are in the order of their elevations at every azimuth
};

class TilePlan {
  public:
    // Plans the sweeps of a tile. There is at least one sweep, and `adjacent_to_next` has an entry
    // for each.
    void make(std::span<const PolarSweep> sweeps, const std::vector<bool>& adjacent_to_next,
              const PolarBounds& bounds, const SampleReach& reach);
    // Returns the planned sweeps, at least one, in rising order.
    [[nodiscard]] std::span<const PlannedSweep> sweeps() const { return planned_; }

  private:
    std::vector<PlannedSweep> planned_;
    std::vector<std::optional<CellStatus>> uniform_;
};

}  // namespace stormcellar::grid
