// grid/fill/mixed_column.h -- the cells of one column from a mixture of gates of each sweep.
//
// The general form of grid/fill/column.h, for interpolations that take several gates of a sweep and
// for cells with an extent. At a height, sweeps count by the interpolation:
//   nearest, linear, eight_point   the two adjacent sweeps around it, linear in height (or the
//                                  nearer alone)
//   beam_weighted                  every sweep on the same side of lost cuts by the antenna's
//                                  pattern (grid/beam/beam_pattern.h), the angle off its axis being
//                                  the difference in height over the beam's rise by degree
// Outside of them (below the lowest, above the highest, beside a lost cut) the nearer sweep counts
// within its edges, else it is not seen. A cell with an extent is the mean over four heights in
// the middle of the quarters of its level, which reaches half way to its neighbours.
#pragma once

#include <span>
#include <vector>

#include "grid/fill/beam_mixture.h"
#include "grid/sweep/mixture.h"
#include "stormcellar/grid/method.h"

namespace stormcellar::grid {

// Heights at which a column is taken, for each level in turn; one or four a level.
[[nodiscard]] std::vector<float> heights_of_levels(std::span<const float> levels_m,
                                                   CellExtent cell);

// One column after another; each height is found from the last one, so take them as they rise.
// Threads: one object a thread.
class MixedColumn {
  public:
    MixedColumn(Interpolation interpolation, float beam_width_deg, Blending blending)
        : interpolation_(interpolation), beam_width_deg_(beam_width_deg), blending_(blending) {}

    // At least one; they must outlive the column.
    void start(std::span<const BeamMixture> beams);
    // What the beams make up at a height.
    [[nodiscard]] Mixture at(float height_m);
    // The same as a cell.
    [[nodiscard]] CellResult cell_at(float height_m);
    // The mean of several heights that rise by even steps, as a cell.
    [[nodiscard]] CellResult mean_at(std::span<const float> heights_m);

  private:
    [[nodiscard]] bool is_between_adjacent() const {
        return above_ > 0 && above_ < beams_.size() && beams_[above_ - 1].adjacent_to_next;
    }
    // No beam counts that is farther off than this, whatever is rounded.
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
    float steepest_m_per_deg_ = 0;  // of any beam's rise
    std::size_t above_ = 0;         // the first beam above the height; beams_.size(): none
    std::vector<float> weights_;
};

}  // namespace stormcellar::grid
