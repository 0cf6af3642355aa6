// tests/grid/slow_details.h -- a slow and obvious form (oracle) of stormcellar/grid/cell_details.h
// for point samples of the nearest gates. It computes one column at a time, in long double, without
// tables.
#pragma once

#include <optional>
#include <vector>

#include "stormcellar/grid/grid.h"
#include "stormcellar/grid/sweep_choice.h"

namespace stormcellar::grid {

struct SlowDetails {
    double seen = 0;
    std::optional<double> age_s, height_offset_m, distance_m;
    std::vector<std::size_t> sweeps;  // sweeps that make up the cell
    std::size_t nearest = 0;          // nearest of the sweeps that see the cell
};

class SlowColumn {
  public:
    struct Setting {
        level2::Moment moment = level2::Moment::ref;
        double beam_width_deg = 0.95;
        bool nearest = false;  // true for Interpolation::nearest
        std::optional<UtcTime> frame_time;
    };
    SlowColumn(const level2::Volume& volume, const std::vector<ChosenSweep>& chosen,
               const Setting& setting, const SitePosition& site, const GridSpec& spec, int ix,
               int iy);

    // Returns true if another gate, radial or beam may be the nearest within the gridder's
    // accuracy.
    [[nodiscard]] bool is_doubtful() const { return doubtful_; }
    [[nodiscard]] SlowDetails at(double height_m) const;

  private:
    using Real = long double;
    struct Beam {
        std::size_t sweep = 0;
        Real height_m = 0, lower_m = 0, upper_m = 0;
        bool adjacent_to_next = true;
        bool is_seen = false;
        std::optional<Real> age_s;
        Real gate_height_m = 0, gate_off_m = 0;  // gate_off_m: distance in the plane about the site
    };
    struct Place {
        Real azimuth_deg = 0, arc_m = 0;
    };
    void add_sweep(const level2::Sweep& sweep, const ChosenSweep& chosen, const Place& column);
    void look_at_gate(const level2::Sweep& sweep, std::uint32_t radial, Real sweep_range_m,
                      const Place& column, Beam& beam);
    [[nodiscard]] std::optional<std::uint32_t> nearest_radial(const level2::Sweep& sweep,
                                                              const ChosenSweep& chosen,
                                                              Real azimuth_deg);
    [[nodiscard]] std::vector<std::pair<const Beam*, Real>> shares(Real height_m) const;
    [[nodiscard]] Real arc_of(Real range_m, Real elevation_deg) const;
    [[nodiscard]] Real height_of(Real range_m, Real elevation_deg) const;
    [[nodiscard]] Real range_over(Real arc_m, Real elevation_deg) const;

    Setting setting_;
    Real radius_m_ = 0, altitude_m_ = 0;
    std::vector<Beam> beams_;
    bool doubtful_ = false;
};

}  // namespace stormcellar::grid
