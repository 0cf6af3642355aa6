// stormcellar/grid/grid_sampler.h -- samples a grid between its cells, from the eight cells around
// a place with linear weights.
//
// A place is within the grid if it is between the centers of the outermost cells. In a grid with
// one level, the place must be exactly at that level.
//
// Units     Columns are counted as in GridProjection (ix is the center of column ix). Levels are
//           counted in the same way; between two levels they are linear in height (meters).
// Threads   Immutable; any thread may use it. The bytes of the view must outlive it.
// Errors    None; a place outside the grid gives false or none.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "stormcellar/grid/brick_view.h"
#include "stormcellar/grid/projection.h"

namespace stormcellar::grid {

class GridSampler {
  public:
    struct Corner {
        CellStatus status = CellStatus::not_seen;
        float value = 0;   // if the status is `value`
        float weight = 0;  // the weights of all eight add up to 1
    };
    using Corners = std::array<Corner, 8>;

    explicit GridSampler(const BrickView& view);

    // Returns the place of a height among the levels, linear between them. Returns NaN below the
    // lowest level and above the highest.
    [[nodiscard]] double level_at(double height_m) const;
    // Finds the eight cells around a place and their weights. Returns false if the place is outside
    // the grid or NaN. If all eight are in a brick with a single status, the first cell has all the
    // weight.
    [[nodiscard]] bool find(ColumnPoint column, double level, Corners& corners) const;
    // Returns the weighted mean, or none unless every cell with a weight above 0 has a value.
    [[nodiscard]] std::optional<float> value(ColumnPoint column, double level) const;

    [[nodiscard]] const BrickView& view() const { return view_; }

  private:
    // The terms that a cell's index on one axis adds to its address and to its brick number.
    struct Step {
        std::size_t offset = 0;
        std::size_t brick = 0;
    };
    struct Cell {
        int ix = 0, iy = 0, iz = 0;
    };
    [[nodiscard]] std::size_t brick_of(int ix, int iy, int iz) const;
    void read(Cell cell, Corner& corner) const;

    BrickView view_;
    std::vector<Step> x_, y_, z_;
};

}  // namespace stormcellar::grid
