// grid/sweep/sweep_clock.h -- computes when the radar measured each place of a grid.
//
// A volume takes minutes: its sweeps follow each other, and the antenna turns once in each sweep. A
// grid keeps a SweepTime for each sweep. From these the clock computes the time of any cell.
//
// Model     The antenna turns clockwise at constant speed. The time of a cell is the mean of the
//           times of two sweeps, with weights linear in height: the sweeps whose beams (4/3 earth)
//           pass next below and next above it. Above and below all beams, only the nearest sweep
//           counts.
// Accuracy  In real volumes, 95 % of the cells differ from the mean time of their gates
//           (Detail::age) by less than 2 s, or by less than 6 % of the longest time from one sweep
//           to the next if that is more. The causes are radials above or below the median of their
//           sweep, and sweeps of more than a turn, which see some azimuths twice. Enforced by
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

// A speed above this counts as unknown, because no antenna turns so fast.
inline constexpr double fastest_turn_deg_per_s = 360;

// Returns a SweepTime for each sweep that has times, in order.
[[nodiscard]] std::vector<SweepTime> sweep_times(const level2::Volume& volume,
                                                 std::span<const ChosenSweep> sweeps);

class SweepClock {
  public:
    // Returns the clock of a volume. Returns none if there are no sweeps, or if a sweep is more
    // than 10 minutes from `middle`, the middle time of the volume; such times are wrong and would
    // move echo too far. The caller then uses one time for the whole volume.
    [[nodiscard]] static std::optional<SweepClock> of_volume(std::span<const SweepTime> sweeps,
                                                             BeamGeometry beam, UtcTime origin,
                                                             UtcTime middle);
    // Times are in seconds since `origin`. `sweeps` must have at least one sweep, and be in order
    // of rising elevation.
    SweepClock(std::span<const SweepTime> sweeps, BeamGeometry beam, UtcTime origin);

    // Computes the time of each level of a column.
    void read(double azimuth_deg, double arc_m, std::span<const double> levels_m,
              std::span<float> seconds) const;
    // Return the bounds of all times: no cell is earlier than earliest_s() or later than
    // latest_s().
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
