// render/products/cell_mixer.h -- mixes the cells of a grid for a place between them.
//
// The mixer applies the status rule (docs/geometry.md, grid/sweep/mixture.h) with the weights of
// the cells. The result is not seen if more than half of the weight is not seen; else range folded
// if that is the largest part; else no echo if that outweighs the values; else the weighted mean of
// the values. Cells with no echo do not lower a value, because a grid does not hold the detection
// limits of its cells. PHI is averaged on its circle of 360 degrees. For VEL, whose circle a grid
// does not hold, the value that weighs most is the result.
//
// Threads   Plain values.
#pragma once

#include <array>
#include <cstddef>

#include "grid/sweep/mixture.h"
#include "stormcellar/grid/brick_view.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::render {

// Returns the content of a cell, which must exist. `half_period` becomes the half period of the
// cell, because a grid does not hold Nyquist velocities.
[[nodiscard]] grid::Sample cell_of(const grid::BrickView& view, float half_period, int ix, int iy,
                                   int iz);

// Mixes up to eight cells with weights of 0 to 1.
class CellMixer {
  public:
    explicit CellMixer(level2::Moment moment);

    void clear() { count_ = 0; }
    // Adds a cell. Ignores a weight of 0, and any cell after the eighth.
    void add(const grid::Sample& cell, double weight);
    [[nodiscard]] grid::CellResult result() const;

  private:
    struct Part {
        grid::Sample cell;
        float weight = 0;
    };
    grid::Blending blending_;
    std::array<Part, 8> parts_{};
    std::size_t count_ = 0;
};

// The two levels around a height, and the share of the upper level. If the height is at a level,
// both are this level. For heights below the first level or above the last, but within the cells of
// that level, both are that level.
struct LevelPair {
    int lower = 0, upper = 0;
    double upper_share = 0;
};
// Returns the levels around a height. Errors: bad_argument if the grid has no cells at the height;
// the message gives the heights of the grid.
[[nodiscard]] Result<LevelPair> levels_about(const grid::GridSpec& spec, double height_m);

}  // namespace stormcellar::render
