// grid/fill/mixed_column.h -- makes the cells of one column from a mixture of gates of each sweep.
//
// This is the general form of grid/fill/column.h. It is for interpolations that take several gates
// of a sweep, and for cells with an extent. The interpolation decides how much each sweep counts at
// a height:
//   nearest, linear, eight_point  The two adjacent sweeps around the height, linear in height (or
//                                 only the nearer sweep).
//   beam_weighted                 All sweeps that no lost cut separates from the height, by the
//                                 antenna's pattern (grid/beam/beam_pattern.h). The angle off the
//                                 axis is the difference in height divided by the beam's rise per
//                                 degree.
// Elsewhere (below the lowest beam, above the highest, beside a lost cut) the sweep whose edges
// enclose the height counts, or the nearer sweep if the edges of two sweeps enclose it;
// beam_weighted adds the neighbors of this sweep. If no edges enclose the height, the height is not
// seen. A cell with an extent is the mean over four heights. A level reaches half way to its
// neighbors, and the four heights are the middles of its quarters.
//
// Threads   One thread at a time may use a MixedColumn.
#pragma once

#include <span>
#include <vector>

#include "grid/fill/beam_mixture.h"
#include "grid/sweep/mixture.h"
#include "stormcellar/grid/method.h"

namespace stormcellar::grid {

// Returns the heights at which a column is evaluated, level by level. There is one height for each
// level, or there are four for cells with an extent.
[[nodiscard]] std::vector<float> heights_of_levels(std::span<const float> levels_m,
                                                   CellExtent cell);

// Evaluates columns, one at a time. Pass the heights of a column in rising order, because each
// search starts at the last height.
class MixedColumn {
  public:
    MixedColumn(Interpolation interpolation, float beam_width_deg, Blending blending)
        : interpolation_(interpolation), beam_width_deg_(beam_width_deg), blending_(blending) {}

    // Starts a column with at least one beam. The beams must outlive the column.
    void start(std::span<const BeamMixture> beams);
    // Returns the mixture of the beams at a height.
    [[nodiscard]] Mixture at(float height_m);
    // Returns the cell that the beams make at a height.
    [[nodiscard]] CellResult cell_at(float height_m);
    // Returns the cell that is the mean over several heights, which rise by equal steps.
    [[nodiscard]] CellResult mean_at(std::span<const float> heights_m);

  private:
    [[nodiscard]] bool is_between_adjacent() const {
        return above_ > 0 && above_ < beams_.size() && beams_[above_ - 1].adjacent_to_next;
    }
    // Returns the difference in height beyond which no beam counts, with a margin for rounding.
    [[nodiscard]] float reach_m_of(float width_deg) const {
        return 1.001F * width_deg * steepest_m_per_deg_;
    }
    [[nodiscard]] float width_between_deg() const;
    [[nodiscard]] bool are_outside(float lowest_m, float highest_m) const;
    [[nodiscard]] bool is_quiet_around(float height_m) const;
    void find(float height_m);
    [[nodiscard]] Mixture between(float height_m);
    [[nodiscard]] Mixture outside(float height_m);
    [[nodiscard]] Mixture by_pattern(std::size_t nearest, float height_m, float width_deg);

    Interpolation interpolation_;
    float beam_width_deg_;
    Blending blending_;
    std::span<const BeamMixture> beams_;
    float steepest_m_per_deg_ = 0;  // the largest rise of any beam
    // The first beam above the height; beams_.size() if there is none.
    std::size_t above_ = 0;
    std::vector<float> weights_;
};

}  // namespace stormcellar::grid
