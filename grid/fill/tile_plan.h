// grid/fill/tile_plan.h -- which sweeps have to be sampled over a tile, and which need not even be
// looked at.
//
// A sweep that is no echo, or not seen, all over a tile needs no sampling. Where the sweeps around
// it are too, it changes no cell: what lies between two like states is that state.
// Threads: one plan a thread. Exact: a grid has the same bits as if every sweep were sampled in
// every column.
#pragma once

#include <span>
#include <vector>

#include "grid/sweep/polar_sweep.h"

namespace stormcellar::grid {

struct PlannedSweep {
    std::size_t index = 0;                     // into the sweeps
    bool sampled = true;                       // else it is `status` all over the tile
    CellStatus status = CellStatus::not_seen;  // where it is not sampled
    bool adjacent_to_next = true;              // of those planned
};

// How far the samples of a column reach, and how many sweeps up and down make up a cell.
struct SampleReach {
    float azimuth_deg = 0;
    float arc_m = 0;
    int sweeps = 1;
    bool in_order = true;  // sweeps are as high as their numbers say at every azimuth
};

class TilePlan {
  public:
    // `adjacent_to_next` has one entry a sweep; at least one sweep.
    void make(std::span<const PolarSweep> sweeps, const std::vector<bool>& adjacent_to_next,
              const PolarBounds& bounds, const SampleReach& reach);
    // Rising, at least one.
    [[nodiscard]] std::span<const PlannedSweep> sweeps() const { return planned_; }

  private:
    std::vector<PlannedSweep> planned_;
    std::vector<std::optional<CellStatus>> uniform_;
};

}  // namespace stormcellar::grid
