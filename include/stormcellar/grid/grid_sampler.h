// stormcellar/grid/grid_sampler.h -- a grid between its cells: the eight around a place, with
// linear weights.
//
// Units   columns as GridProjection has them (ix at the centre of column ix); levels likewise, with
//         heights in metres between them.
// A place is within the grid where cells are on all sides of it: up to the centres of the outermost
// cells, and exactly at the level of a grid that has one.
// Threads immutable; the view must outlive it.
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
        float value = 0;   // where that is `value`
        float weight = 0;  // of all eight: 1
    };
    using Corners = std::array<Corner, 8>;

    explicit GridSampler(const BrickView& view);

    // Where a height lies among the levels, linear between them; NaN below the lowest and above
    // the highest.
    [[nodiscard]] double level_at(double height_m) const;
    // False where the place is not within the grid. NaN is nowhere. Where all eight are of one
    // state the first may have all the weight.
    [[nodiscard]] bool find(ColumnPoint column, double level, Corners& corners) const;
    // The weighted mean where every cell that has a weight has a value.
    [[nodiscard]] std::optional<float> value(ColumnPoint column, double level) const;

    [[nodiscard]] const BrickView& view() const { return view_; }

  private:
    // Of a cell along one axis: parts of its address and of its brick's number.
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
