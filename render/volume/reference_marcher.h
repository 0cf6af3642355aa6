// render/volume/reference_marcher.h -- the slicer's oracle: slow, in double, one ray at a time.
//
// The same picture in the limit of infinitely many slices, by the rules of render/volume/slicer.h
// but with none of its tables: each sample's value looks up the colour table itself. Steps are
// taken at their middles, so the error falls with the square of their length where colours are
// smooth, and with the length where they are stepped.
// A ray that falls below the box has met the earth, which hides what lies beyond its curve.
// Cost: four bytes of memory a cell, some 20 ns a step.
// Thread contract: immutable; ray() may run on many threads.
#pragma once

#include <array>
#include <vector>

#include "stormcellar/grid/brick_view.h"
#include "stormcellar/render/colour_table.h"
#include "stormcellar/render/view_geometry.h"

namespace stormcellar::render {

class ReferenceMarcher {
  public:
    // The geometry must outlive this.
    ReferenceMarcher(const grid::BrickView& view, const ColourTable& table,
                     const ViewGeometry& geometry, double opacity);

    // Red, green and blue, premultiplied, and alpha; 0..1. `steps` between the nearest and the
    // farthest depth of the box.
    [[nodiscard]] std::array<double, 4> ray(Pixel pixel, int steps) const;

    // Value and share of valued cells at a point of drawn space; share 0: nothing there.
    struct Sample {
        double value = 0, share = 0;
    };
    [[nodiscard]] Sample sample(const Vec3& point) const;

  private:
    [[nodiscard]] bool is_inside(const Vec3& point) const;

    const ViewGeometry& geometry_;
    const ColourTable table_;
    const grid::GridSpec spec_;
    double opacity_;
    std::vector<float> values_;  // z fastest, then y, then x; NaN where there is none
};

}  // namespace stormcellar::render
