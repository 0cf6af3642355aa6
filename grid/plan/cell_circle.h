// grid/plan/cell_circle.h -- the difference between two values of a cell, for moments that may
// wrap.
//
// VEL is on a circle of twice the Nyquist velocity and PHI on one of 360 degrees, so their values
// differ by the shorter way round. Sweeps may have different Nyquist velocities. A cell uses the
// circle of the two sweeps whose beams (4/3 earth) pass next above and below it. If these have
// different circles, the longer of both ways is taken, so that no difference looks smaller than it
// is. If a circle is not known, and for all other moments, values differ as plain numbers.
//
// Threads   One thread for each object.
#pragma once

#include <cstddef>
#include <vector>

#include "stormcellar/grid/beam_model.h"
#include "stormcellar/grid/grid.h"
#include "stormcellar/grid/sweep_choice.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::grid {

class CellCircles {
  public:
    CellCircles(const level2::Volume& volume, const std::vector<ChosenSweep>& chosen,
                const SitePosition& site, const GridSpec& spec, level2::Moment moment);

    // Makes differences refer to cells of the column at this distance, until the next call.
    void move_to(double arc_m);
    // Returns a - b.
    [[nodiscard]] double difference(float a, float b, std::size_t level) const;

  private:
    struct Sweep {
        BeamPath path;
        double period = 0;  // 0: not known
        double height_m = 0;
    };
    std::vector<Sweep> sweeps_;  // empty: as plain numbers
    std::vector<double> levels_m_;
};

}  // namespace stormcellar::grid
