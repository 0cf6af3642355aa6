// render/volume/shade_field.h -- computes how much lighter or darker than its own color each part
// of a volume is drawn.
//
// The field is made once for each time step, on a grid of 2 x 2 columns and single levels. It holds
// the factor
//   shade = S T + 0.25 s (1 - |n v|)^3,    S = 1 + 0.4 s n u,    T = 1 + 0.45 (t - 0.6)
// Here n is the direction in which the values fall, v the direction of view, and u the direction of
// the sun. With g the gradient of the values, s = g / (g + 1.5 dB per km of drawn space) tells how
// much the place is like a surface. t is the light that gets through from the sun and the sky
// (render/volume/light_volume.h). s belongs to `gradient`, and t to `shadow` and `scattering`
// (stormcellar/render/light.h). If a scene does not ask for these kinds of light, s = 0 or T = 1. A
// factor of 1 does not change a color.
//
// The value of a cell is its reflectivity above 0 dBZ (or above the lowest color of the table, if
// that is lower), counted up to 60 dBZ. Any value of another moment counts as 30. Values are
// averaged over 2 x 2 columns and smoothed along each axis by 1-4-6-4-1. Air without echo counts as
// 0. A cell that was not seen or is range folded takes the value of the next seen cell below it,
// or, if there is none, of the lowest seen cell of its column. So neither the cone of silence nor
// the lowest beam looks like a surface.
//
// Cost      12 bytes for each coarse cell while it is made, 4 bytes afterward.
// Threads   Immutable. The same bits for any number of threads.
// Accuracy  Steps of 1/128, from 0 to 255/128.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "render/volume/light_volume.h"
#include "stormcellar/grid/brick_view.h"
#include "stormcellar/render/color_table.h"

namespace stormcellar::render {

class ShadeField {
  public:
    static constexpr int cells_across = 2;
    static constexpr float of_code = 1.0F / 128;

    // `volume` may be null if `light` asks for neither shadow nor scattering.
    ShadeField(const grid::BrickView& view, const ColorTable& table, const ViewGeometry& geometry,
               const Light& light, const LightVolume* volume, int threads);

    // Returns the factor at a place in cells and levels: trilinear, and constant beyond the edges.
    // The rays of the slicer read the same factor in single precision.
    [[nodiscard]] double at(double x, double y, double z) const;

    // Returns, for each coarse cell, the codes of four neighboring columns in one word, as in a
    // CornerTable.
    [[nodiscard]] const std::byte* words() const {
        return reinterpret_cast<const std::byte*>(words_.data());
    }
    [[nodiscard]] std::int32_t stride_x() const { return sizes_[1] * stride_y(); }
    [[nodiscard]] std::int32_t stride_y() const { return sizes_[2] + 1; }
    [[nodiscard]] int size(std::size_t axis) const { return sizes_[axis]; }

  private:
    class Baker;

    std::array<int, 3> sizes_{};
    std::vector<std::uint32_t> words_;
};

}  // namespace stormcellar::render
