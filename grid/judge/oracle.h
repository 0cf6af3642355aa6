// grid/judge/oracle.h -- the gridder's oracle. It computes one cell at a time, without shared work
// or tables, and with long double where it matters.
//
// The oracle is slow and obvious, and follows docs/geometry.md instead of the gridder. Tests and
// the accuracy ladder compare the gridder with it. For each column it solves the geodesic and the
// beams anew, and searches every radial. For each cell it lists all gates with their weights.
//
// Within its stated accuracy, the gridder may choose another nearest gate for a column than the
// oracle. is_doubtful() returns true for a column in which this may happen: its result would change
// if the column were shifted by less than doubt_range_m or doubt_azimuth_deg, or if beams whose
// heights differ by less than doubt_height_m changed their order.
//
// Threads   One thread for each object.
#pragma once

#include <memory>
#include <vector>

#include "grid/judge/oracle_sweep.h"

namespace stormcellar::grid {

struct OracleCell {
    CellStatus status = CellStatus::not_seen;
    double value = 0;
    double unseen = 1;  // the share of the weight that is not seen
    // The smallest change of a weight that could change the status.
    double margin = 1;
    // True if the values cover more than a quarter of their circle, or if their circles differ. The
    // mean then depends on the value from which differences are taken.
    bool wide_on_circle = false;
};

class OracleColumn {
  public:
    static constexpr double doubt_range_m = 0.2;
    static constexpr double doubt_azimuth_deg = 1e-4;
    static constexpr double doubt_height_m = 1;

    // `volume`, `chosen` and `setting` must outlive the object. Column and row must be in the spec.
    OracleColumn(const level2::Volume& volume, const std::vector<ChosenSweep>& chosen,
                 const OracleSetting& setting, const SitePosition& site, const GridSpec& spec,
                 int ix, int iy);

    [[nodiscard]] bool is_doubtful() const { return doubtful_; }
    // Computes the cell at a level of the spec, raised by `raised_m`. The cell has the extent that
    // the setting says.
    [[nodiscard]] OracleCell cell(std::size_t level, double raised_m = 0) const;

  private:
    struct Beam {
        std::vector<WeightedGate> gates;  // the weights add up to 1
        double height_m = 0, lower_edge_m = 0, upper_edge_m = 0, rise_m_per_deg = 0;
        bool adjacent_to_next = true;
    };
    [[nodiscard]] static double rise_of(const Beam& beam, double range_m, double half_deg);
    void put_in_order();
    using Share = std::pair<const Beam*, double>;
    [[nodiscard]] std::vector<Share> beams_at(double height_m) const;
    [[nodiscard]] std::vector<Share> by_pattern(std::size_t nearest, double height_m,
                                                double width_deg) const;
    [[nodiscard]] OracleCell decide(const std::vector<WeightedGate>& gates) const;

    OracleSetting setting_;
    std::vector<double> levels_m_;
    std::vector<Beam> beams_;
    bool doubtful_ = false;
};

}  // namespace stormcellar::grid
