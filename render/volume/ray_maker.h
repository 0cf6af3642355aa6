// render/volume/ray_maker.h -- pixels -> rays in cell positions, clipped to the box of the cells.
//
// SIMD by Highway; the same bits on every target. Thread contract: immutable.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "render/volume/level_position.h"
#include "render/volume/ray_packet.h"
#include "stormcellar/render/view_geometry.h"

namespace stormcellar::render {

// The middle of a pixel is half a pixel further.
struct PixelPlace {
    int x = 0, y = 0;
};

// What the rays of a picture have in common, in drawn space: start and step of a ray are linear in
// the pixel.
struct RayLines {
    struct Linear {
        Vec3 origin{}, per_x{}, per_y{};
        [[nodiscard]] double at(std::size_t axis, double x, double y) const {
            return origin[axis] + x * per_x[axis] + y * per_y[axis];
        }
    };
    Linear start, step;
    Vec3 scale{}, offset{};  // to cell positions
    Vec3 low{}, high{};      // the box of the cells
    double slices = 1, step_m = 1;
    bool parallel = true;
};

class RayMaker {
  public:
    // The geometry must outlive this.
    RayMaker(const grid::GridSpec& spec, const ViewGeometry& geometry, const LevelPosition& levels,
             int slices);

    // At most packet_rays of them; rays without a pixel see nothing.
    [[nodiscard]] RayPacket packet(std::span<const PixelPlace> pixels) const;

    // None where the earth is drawn flat.
    [[nodiscard]] const CurvedLevels* curve() const { return curve_ ? &*curve_ : nullptr; }

  private:
    void clip_to_curved_box(std::span<const PixelPlace> pixels, RayPacket& rays) const;

    const ViewGeometry& geometry_;
    RayLines lines_;
    std::optional<CurvedLevels> curve_;
};

}  // namespace stormcellar::render
