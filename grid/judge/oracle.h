// grid/judge/oracle.h -- the gridder's oracle: one cell at a time, nothing shared, nothing
// tabulated, long double where it matters. Slow and obvious, written from docs/geometry.md and not
// from the gridder; tests and the accuracy ladder compare the gridder with it.
//
// The geodesic to a column and the beam over it are solved anew for each column, every radial is
// searched, and a cell keeps the list of all gates that make it up, each with its weight.
// What the gridder's stated accuracies allow can change which gate is nearest: a column says when
// that hung on less than doubt_range_m or doubt_azimuth_deg, or two beams are as high as each other
// within doubt_height_m.
// Threads: use one from one thread.
#pragma once

#include <memory>
#include <vector>

#include "grid/judge/oracle_sweep.h"

namespace stormcellar::grid {

struct OracleCell {
    CellStatus status = CellStatus::not_seen;
    double value = 0;
    double unseen = 1;  // share of the weight
    // How far the status rule was from another outcome, in weight.
    double margin = 1;
    // The values cover more than a quarter of their circle, or circles differ: the mean depends
    // on which of them it is taken from.
    bool wide_on_circle = false;
};

class OracleColumn {
  public:
    static constexpr double doubt_range_m = 0.2;
    static constexpr double doubt_azimuth_deg = 1e-4;
    static constexpr double doubt_height_m = 1;

    // `volume` and `chosen` must outlive it. Column and row must be in the spec.
    OracleColumn(const level2::Volume& volume, const std::vector<ChosenSweep>& chosen,
                 const OracleSetting& setting, const SitePosition& site, const GridSpec& spec,
                 int ix, int iy);

    [[nodiscard]] bool is_doubtful() const { return doubtful_; }
    // A level of the spec, as a point or with its extent, raised by an offset.
    [[nodiscard]] OracleCell cell(std::size_t level, double raised_m = 0) const;

  private:
    struct Beam {
        std::vector<WeightedGate> gates;  // weights sum to 1
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
