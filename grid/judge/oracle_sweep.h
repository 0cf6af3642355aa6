// grid/judge/oracle_sweep.h -- finds the gates of one sweep from which a point or a cell is made.
// It does so slowly: each call searches every radial (grid/judge/oracle.h).
//
// Threads   One thread for each object.
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
    // The profile for traced beams; none: the exponential reference atmosphere.
    std::optional<RefractivityProfile> profile;
};

struct WeightedGate {
    CellStatus status = CellStatus::not_seen;
    double value = 0, limit_dbz = 0, half_period = 0, weight = 1;
};

class OracleSweep {
  public:
    // The sweep, the choice and the setting must outlive the object.
    OracleSweep(const level2::Sweep& sweep, const ChosenSweep& chosen,
                const OracleSetting& setting);

    // Returns the measured elevation of the radial that sees the azimuth, or the elevation of the
    // sweep if no radial does. Sets `doubtful` if another radial may be the nearest, within
    // OracleColumn's margins.
    [[nodiscard]] double elevation_deg(double azimuth_deg, bool& doubtful) const;

    // Returns the gates for a point, by the interpolation of the setting. Their weights add up to
    // 1.
    [[nodiscard]] std::vector<WeightedGate> point(double azimuth_deg, double range_m,
                                                  bool& doubtful) const;

    // Returns all gates for which `is_inside(azimuth_deg, range_m)` is true, with equal weights.
    // Places beyond the last gate of a radial count as not seen. If no gate is inside, the result
    // is empty. The search covers `near_deg` on each side of the azimuth, and ranges from
    // `nearest_m` to `farthest_m`.
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

// Returns the antenna's pattern (grid/beam/beam_pattern.h), computed in double.
[[nodiscard]] double oracle_pattern(double offset, double width);

}  // namespace stormcellar::grid
