// render/products/smooth_field.h -- smooths a map between the cells of its grid, only for looks.
//
// A plain map shows each cell as a square. In a smoothed map, values change smoothly from cell to
// cell. They follow a cubic of Catmull and Rom through 4 x 4 cells, which never leaves the range of
// the four cells around a place. The state is decided first. Then values are mixed only with other
// values:
//   state    If each of the four cells has a value or no echo, the result is a value if the cells
//            with values have half of the bilinear weight or more, else no echo. Otherwise the
//            result has the state of the nearest cell.
//   value    The cubic needs a value in every cell. So if one of the four cells has no value, it
//            gets the mean of the cells with a value. If one of the twelve cells around the four
//            has no value, it gets the value of the nearest of the four.
// At the center of a cell, the result is exactly the cell. Beyond the outermost centers, the cells
// at the edge are repeated.
//
// Values on a circle (VEL, PHI) are not smoothed, because a grid does not say where they wrap.
//
// Threads   Immutable.
// Accuracy  tests/render/smooth_field_test.cpp compares it with a slow form, for all patterns of
//           states of 4 x 4 cells.
#pragma once

#include "render/products/flat_field.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::render {

// Returns true if the scene's map is drawn smoothed.
[[nodiscard]] bool is_smoothed(const Scene& scene);

class SmoothField {
  public:
    // The field must outlive the object.
    explicit SmoothField(const FlatField& field) : field_(field) {}

    struct Place {
        grid::CellStatus status = grid::CellStatus::not_seen;
        float value = 0;  // 0 if the status is not value
    };
    // Returns the content of a place in cells, where cell (0, 0) has its center at 0, 0.
    [[nodiscard]] Place at(double x, double y) const;

  private:
    [[nodiscard]] float value_at(int x, int y, float beyond_x, float beyond_y) const;

    const FlatField& field_;
};

}  // namespace stormcellar::render
