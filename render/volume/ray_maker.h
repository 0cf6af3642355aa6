// render/volume/ray_maker.h -- makes rays in positions of cells from pixels, clipped to the box of
// the cells.
//
// The code uses SIMD by Highway, with the same bits on every target.
//
// Threads   Immutable.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "render/volume/level_position.h"
#include "render/volume/ray_packet.h"
#include "stormcellar/render/view_geometry.h"

namespace stormcellar::render {

// A pixel. Its middle is half a pixel farther to the right and down.
struct PixelPlace {
    int x = 0, y = 0;
};

// The geometry that all rays of a picture share, in drawn space. The start and the step of a ray
// are linear in the pixel.
struct RayLines {
    struct Linear {
        Vec3 origin{}, per_x{}, per_y{};
        [[nodiscard]] double at(std::size_t axis, double x, double y) const {
            return origin[axis] + x * per_x[axis] + y * per_y[axis];
        }
    };
    Linear start, step;
    Vec3 scale{}, offset{};  // convert to positions of cells
    Vec3 low{}, high{};      // the box of the cells
    double slices = 1, step_m = 1;
    bool parallel = true;
};

class RayMaker {
  public:
    // The geometry must outlive this object.
    RayMaker(const grid::GridSpec& spec, const ViewGeometry& geometry, const LevelPosition& levels,
             int slices);

    // Makes the rays of at most packet_rays pixels. Rays that have no pixel see nothing.
    [[nodiscard]] RayPacket packet(std::span<const PixelPlace> pixels) const;

    // Returns null if the earth is drawn flat.
    [[nodiscard]] const CurvedLevels* curve() const { return curve_ ? &*curve_ : nullptr; }

  private:
    void clip_to_curved_box(std::span<const PixelPlace> pixels, RayPacket& rays) const;

    const ViewGeometry& geometry_;
    RayLines lines_;
    std::optional<CurvedLevels> curve_;
};

}  // namespace stormcellar::render
