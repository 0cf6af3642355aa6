// tests/grid/slow_gridder.h -- the gridder's oracle: one cell at a time, nothing shared, nothing
// tabulated, long double where it matters. Written from docs/geometry.md, not from the gridder.
#pragma once

#include <vector>

#include "grid/grid.h"
#include "grid/sweep_choice.h"
#include "level2/volume.h"

namespace stormcellar::grid {

struct SlowCell {
    CellStatus status = CellStatus::not_seen;
    double value = 0;
};

// A column: how the sweeps see it, solved without tables.
class SlowColumn {
  public:
    SlowColumn(const level2::Volume& volume, const std::vector<ChosenSweep>& chosen,
               level2::Moment moment, const SitePosition& site, const GridSpec& spec, int ix,
               int iy, double beam_width_deg);

    // A gate or radial was chosen by less than the gridder's stated accuracy.
    [[nodiscard]] bool is_doubtful() const { return doubtful_; }
    [[nodiscard]] SlowCell cell(double level_m) const;

  private:
    struct Beam {
        CellStatus status = CellStatus::not_seen;
        double value = 0;
        double limit_dbz = 0;
        double height_m = 0, lower_edge_m = 0, upper_edge_m = 0;
        bool adjacent_to_next = true;
    };
    void sample(const level2::Sweep& sweep, const ChosenSweep& chosen, level2::Moment moment,
                double azimuth_deg, double range_m, Beam& beam);
    std::vector<Beam> beams_;
    level2::Moment moment_;
    bool doubtful_ = false;
};

}  // namespace stormcellar::grid
