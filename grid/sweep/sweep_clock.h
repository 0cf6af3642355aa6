// grid/sweep/sweep_clock.h -- when the radar looked at each place of a grid.
//
// A volume takes minutes: its sweeps follow each other, and each turns once. A grid keeps a
// SweepTime for each sweep, and from these the clock computes the time of any cell.
//
// Model     The antenna turns clockwise at constant speed. The two sweeps whose beams (4/3 earth)
//           pass next below and above a cell make its time, with weights linear in height. Above
//           and below all beams, the nearest sweep makes it.
// Accuracy  For real volumes, at the 95th percentile of cells: the larger of 2 s and 6 % of the
//           longest time from one sweep to the next, compared with the mean time of the cell's
//           gates (Detail::age). Radials lie higher or lower than the median of their sweep, and a
//           sweep of more than a turn sees some azimuths twice. Enforced by
//           tests/grid/sweep_clock_test.cpp.
// Threads   Immutable.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "stormcellar/base/utc_time.h"
#include "stormcellar/grid/beam_geometry.h"
#include "stormcellar/grid/grid.h"
#include "stormcellar/grid/sweep_choice.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::grid {

// No antenna turns faster. A higher speed counts as not known.
inline constexpr double fastest_turn_deg_per_s = 360;

// Returns one SweepTime for each sweep that has times, in order.
[[nodiscard]] std::vector<SweepTime> sweep_times(const level2::Volume& volume,
                                                 std::span<const ChosenSweep> sweeps);

class SweepClock {
  public:
    // Returns none if there are no sweeps, or if a sweep is more than 10 minutes from the middle of
    // its volume. Such times are wrong, and echo that moves with them would go too far. The volume
    // is then taken as if it had one time.
    [[nodiscard]] static std::optional<SweepClock> of_volume(std::span<const SweepTime> sweeps,
                                                             BeamGeometry beam, UtcTime origin,
                                                             UtcTime middle);
    // Times are in seconds since `origin`. `sweeps` holds at least one sweep, in order of rising
    // elevation.
    SweepClock(std::span<const SweepTime> sweeps, BeamGeometry beam, UtcTime origin);

    // Computes the time for each level of a column.
    void read(double azimuth_deg, double arc_m, std::span<const double> levels_m,
              std::span<float> seconds) const;
    // No cell is earlier or later than these.
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
