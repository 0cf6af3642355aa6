// grid/plan/cell_circle.h -- computes the difference between two values of a cell, for moments that
// may wrap.
//
// Values of VEL are on a circle of twice the Nyquist velocity, and values of PHI on a circle of 360
// degrees. So they differ by the shorter way around. Sweeps may have different Nyquist velocities.
// A cell uses the circles of the two sweeps whose beams (4/3 earth) pass next above and next below
// it. If these circles differ, the circle that gives the larger difference counts, so that no
// difference looks smaller than it is. If a circle is unknown, and for all other moments, values
// differ as plain numbers.
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

    // Makes difference() refer to the column at this arc until the next call of move_to().
    void move_to(double arc_m);
    // Returns a - b for values of the cell at this level.
    [[nodiscard]] double difference(float a, float b, std::size_t level) const;

  private:
    struct Sweep {
        BeamPath path;
        double period = 0;  // 0: unknown
        double height_m = 0;
    };
    std::vector<Sweep> sweeps_;  // empty: values differ as plain numbers
    std::vector<double> levels_m_;
};

}  // namespace stormcellar::grid
