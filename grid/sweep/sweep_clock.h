// grid/sweep/sweep_clock.h -- when each place of a grid was looked at.
//
// A volume takes minutes: its sweeps follow each other, and each turns once. What is kept of them
// in a grid is one line a sweep, from which the time of any cell can be had again. Model     the
// antenna turns clockwise at one speed; a cell is of the two sweeps whose beams (4/3
//           earth) pass next below and above it, by their weights linear in height, and outside of
//           them of the nearest one.
// Accuracy  at the 95th percentile of cells (a sweep of more than a turn sees some azimuths twice)
//           the larger of 2 s and 6 % of the longest time from one sweep to the next, of the mean
//           time of the cell's gates (Detail::age): radials lie higher or lower than their sweep's
//           median. For real volumes; enforced by tests/grid/sweep_clock_test.cpp.
// Threads   immutable.
#pragma once

#include <span>
#include <vector>

#include "stormcellar/base/utc_time.h"
#include "stormcellar/grid/beam_geometry.h"
#include "stormcellar/grid/grid.h"
#include "stormcellar/grid/sweep_choice.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::grid {

// No antenna turns faster: such a speed is taken for not known.
inline constexpr double fastest_turn_deg_per_s = 360;

// One for each of the sweeps that are dated, in their order.
[[nodiscard]] std::vector<SweepTime> sweep_times(const level2::Volume& volume,
                                                 std::span<const ChosenSweep> sweeps);

class SweepClock {
  public:
    // Times are given in seconds since `origin`. `sweeps` in rising elevation, at least one.
    SweepClock(std::span<const SweepTime> sweeps, BeamGeometry beam, UtcTime origin);

    // For each level of a column.
    void read(double azimuth_deg, double arc_m, std::span<const double> levels_m,
              std::span<float> seconds) const;
    // No cell is earlier or later.
    [[nodiscard]] double earliest_s() const { return earliest_s_; }
    [[nodiscard]] double latest_s() const { return latest_s_; }

  private:
    struct Turn {
        BeamGeometry::Angle elevation;
        double start_s = 0;
        double first_azimuth_deg = 0, degrees_per_s = 0;
    };
    [[nodiscard]] static double seconds_of(const Turn& sweep, double azimuth_deg);

    std::vector<Turn> sweeps_;
    BeamGeometry beam_;
    double earliest_s_ = 0, latest_s_ = 0;
};

}  // namespace stormcellar::grid
