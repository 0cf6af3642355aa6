// grid/judge/oracle_sweep.h -- which gates of one sweep make up a point or a cell, found the slow
// way: every radial is searched for each question (grid/judge/oracle.h).
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "stormcellar/grid/grid.h"
#include "stormcellar/grid/method.h"
#include "stormcellar/grid/refractivity.h"
#include "stormcellar/grid/sweep_choice.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::grid {

struct OracleSetting {
    level2::Moment moment = level2::Moment::ref;
    double beam_width_deg = 0.95;
    bool is_tdwr = false;
    Method method;
    // For traced beams; none: the exponential reference atmosphere.
    std::optional<RefractivityProfile> profile;
};

struct WeightedGate {
    CellStatus status = CellStatus::not_seen;
    double value = 0, limit_dbz = 0, half_period = 0, weight = 1;
};

class OracleSweep {
  public:
    // All three must outlive it.
    OracleSweep(const level2::Sweep& sweep, const ChosenSweep& chosen,
                const OracleSetting& setting);

    // The measured elevation of the radial that sees the azimuth; the sweep's where none does.
    // `doubtful` is set when another radial is as near, within OracleColumn's margins.
    [[nodiscard]] double elevation_deg(double azimuth_deg, bool& doubtful) const;

    // The gates that make up a point, their weights' sum 1; by the setting's interpolation.
    [[nodiscard]] std::vector<WeightedGate> point(double azimuth_deg, double range_m,
                                                  bool& doubtful) const;

    // All gates, of equal weight, that `is_inside(azimuth_deg, range_m)`; a place where a gate
    // would stand beyond a radial's last one is not seen. Empty where there is none. `near_deg`
    // about the azimuth bounds the search.
    using Inside = std::function<bool(double azimuth_deg, double range_m)>;
    [[nodiscard]] std::vector<WeightedGate> inside(const Inside& is_inside, double azimuth_deg,
                                                   double near_deg, double nearest_m,
                                                   double farthest_m) const;

  private:
    struct Radial {
        std::uint32_t index = 0;
        double azimuth_deg = 0;
        const level2::SweepMoment* kind = nullptr;
    };
    [[nodiscard]] bool is_joined(std::size_t at) const;
    [[nodiscard]] int nearest(double azimuth_deg, bool& doubtful) const;
    [[nodiscard]] double seen_share(double azimuth_deg, double near_deg) const;
    [[nodiscard]] WeightedGate gate(const Radial& radial, std::int32_t number, double weight) const;
    void add_along(const Radial& radial, double range_m, double weight, bool two,
                   std::vector<WeightedGate>& gates, bool& doubtful) const;
    void add_radials(double azimuth_deg, std::size_t nearest, double range_m,
                     std::vector<WeightedGate>& gates, bool& doubtful) const;

    const level2::Sweep& sweep_;
    const ChosenSweep& chosen_;
    const OracleSetting& setting_;
    std::vector<Radial> radials_;  // by azimuth
    double spacing_deg_ = 1;
};

// The antenna's pattern (grid/beam/beam_pattern.h) in double.
[[nodiscard]] double oracle_pattern(double offset, double width);

}  // namespace stormcellar::grid
