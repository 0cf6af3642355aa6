// render/volume/ray_maker.h -- pixels -> rays in cell positions, clipped to the box of the cells.
//
// Thread contract: immutable.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "render/view_geometry.h"
#include "render/volume/level_position.h"
#include "render/volume/ray_packet.h"

namespace stormcellar::render {

// The middle of a pixel is half a pixel further.
struct PixelPlace {
    int x = 0, y = 0;
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
    using Lane = std::array<double, packet_rays>;
    void clip_to_box(const std::array<Lane, 3>& start, const std::array<Lane, 3>& step,
                     RayPacket& rays) const;
    void clip_to_curved_box(const std::array<Lane, 3>& start, const std::array<Lane, 3>& step,
                            RayPacket& rays) const;

    // Drawn space: a ray's start and its step are linear in the pixel.
    struct Linear {
        Vec3 origin{}, per_x{}, per_y{};
    };
    const ViewGeometry& geometry_;
    double slices_, step_m_;
    Linear start_, step_;
    Vec3 scale_{}, offset_{};  // from drawn space to cell positions
    std::optional<CurvedLevels> curve_;
};

}  // namespace stormcellar::render
