// grid/plan/cell_circle.h -- how far apart two values of a cell are, where the moment may wrap.
//
// VEL lies on a circle of twice the Nyquist velocity, PHI on one of 360 degrees: their values
// differ by the shorter way round. Sweeps may have different Nyquist velocities. A cell's circle is
// that of the two sweeps whose beams (4/3 earth) pass next above and below it; where theirs differ,
// the longer of both ways is taken, so that no difference looks smaller than it is. Where a circle
// is not known, and for all other moments, values differ as numbers. Threads: one object, one
// thread.
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

    // Differences are of cells of the column at this distance until the next call.
    void move_to(double arc_m);
    // a - b.
    [[nodiscard]] double difference(float a, float b, std::size_t level) const;

  private:
    struct Sweep {
        BeamPath path;
        double period = 0;  // 0: not known
        double height_m = 0;
    };
    std::vector<Sweep> sweeps_;  // none: as numbers
    std::vector<double> levels_m_;
};

}  // namespace stormcellar::grid
