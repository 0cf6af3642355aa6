// render/volume/light_volume.h -- computes how much light reaches each part of a volume.
//
// The object holds two transmittances of the echo on a coarse grid (4 x 4 columns, 2 levels):
// toward the sun and, as the mean over nine directions, toward the sky. The object is made once for
// each time step. For each direction, the light is carried from plane to plane along the steepest
// axis. Each plane reads the previous plane bilinearly, which blurs a shadow by about one coarse
// cell for each coarse cell that the shadow crosses.
//
// Cost      12 bytes for each coarse cell while it is made, 4 bytes afterward.
// Threads   Immutable. The same bits for any number of threads.
#pragma once

#include <array>
#include <vector>

#include "render/volume/transfer_function.h"
#include "stormcellar/grid/brick_view.h"
#include "stormcellar/render/light.h"
#include "stormcellar/render/view_geometry.h"

namespace stormcellar::render {

// Returns the direction toward the sun, of unit length, in drawn space.
[[nodiscard]] Vec3 sun_direction(const Light& light);

class LightVolume {
  public:
    static constexpr int cells_across = 4, cells_up = 2;

    // `step_m` must equal the step of the transfer function.
    LightVolume(const grid::BrickView& view, const TransferFunction& transfer, double step_m,
                const ViewGeometry& geometry, const Light& light, int threads);

    // Returns the light, 0..1, at a place in cells and levels. It is trilinear, and constant beyond
    // the edges.
    [[nodiscard]] float at(float x, float y, float z) const;

    // For tests: the light of the sun alone, and the number of coarse cells along an axis.
    [[nodiscard]] float sun_at(int x, int y, int z) const { return sun_[index(x, y, z)]; }
    [[nodiscard]] int size(std::size_t axis) const { return sizes_[axis]; }

  private:
    [[nodiscard]] std::size_t index(int x, int y, int z) const {
        return (static_cast<std::size_t>(x) * static_cast<std::size_t>(sizes_[1]) +
                static_cast<std::size_t>(y)) *
                   static_cast<std::size_t>(sizes_[2]) +
               static_cast<std::size_t>(z);
    }
    void add_extinction(const grid::BrickView& view, const TransferFunction& transfer,
                        double step_m);
    [[nodiscard]] std::vector<float> transmittance(const Vec3& towards) const;

    std::array<int, 3> sizes_{};
    Vec3 widths_m_{};                // of a coarse cell in drawn space
    std::vector<float> extinction_;  // per meter
    std::vector<float> sun_;
    std::vector<float> light_;
};

}  // namespace stormcellar::render
