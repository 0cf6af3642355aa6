// render/volume/reference_marcher.h -- the slicer's oracle: slow, in double, one ray at a time.
//
// The marcher draws the picture in the limit of infinitely many slices. It follows the rules of
// render/volume/slicer.h, but uses none of its tables: each sample looks up its value in the color
// table itself. Steps are sampled at their middles. So the error falls with the square of their
// length if colors are smooth, and with the length if colors are stepped. A ray that falls below
// the box has met the earth, which hides everything beyond its curve.
//
// Cost      Four bytes of memory for each cell, and some 20 ns for each step.
// Threads   Immutable; many threads may call ray().
#pragma once

#include <array>
#include <vector>

#include "render/volume/shade_field.h"
#include "stormcellar/grid/brick_view.h"
#include "stormcellar/render/color_table.h"
#include "stormcellar/render/view_geometry.h"

namespace stormcellar::render {

class ReferenceMarcher {
  public:
    // The geometry must outlive this object.
    ReferenceMarcher(const grid::BrickView& view, const ColorTable& table,
                     const ViewGeometry& geometry, double opacity);

    // Returns red, green and blue, premultiplied, and alpha, all 0..1. `steps` is the number of
    // steps between the nearest and the farthest depth of the box.
    [[nodiscard]] std::array<double, 4> ray(Pixel pixel, int steps) const;
    // Returns the result of ray(), and the sum of the light factors along the ray, weighted by the
    // seen opacity. If `shades` is null, all factors are 1.
    struct Lit {
        std::array<double, 4> color{};
        double light = 0;
    };
    [[nodiscard]] Lit lit_ray(Pixel pixel, int steps, const ShadeField* shades) const;

    // The value and the share of cells with values at a point of drawn space. If the share is 0,
    // there is no value.
    struct Sample {
        double value = 0, share = 0;
    };
    [[nodiscard]] Sample sample(const Vec3& point) const;

  private:
    [[nodiscard]] bool is_inside(const Vec3& point) const;
    [[nodiscard]] double light_at(const ShadeField& shades, const Vec3& point) const;

    const ViewGeometry& geometry_;
    const ColorTable table_;
    const grid::GridSpec spec_;
    double opacity_;
    std::vector<float> values_;  // z runs fastest, then y, then x; NaN if there is no value
};

}  // namespace stormcellar::render
