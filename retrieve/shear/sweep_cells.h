// retrieve/shear/sweep_cells.h -- the radials and gates of a sweep over the cells of a ShearLayer.
//
// Each cell has the nearest radial in azimuth and the nearest gate in range.
//
// Units     Meters and degrees; heights are above the antenna.
// Threads   Immutable.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "stormcellar/grid/beam_geometry.h"
#include "stormcellar/level2/volume.h"
#include "stormcellar/retrieve/velocity_shear.h"

namespace stormcellar::retrieve {

// A gate over an arc.
struct ArcGate {
    std::int32_t gate = -1;  // -1: the sweep has none over this arc
    float height_m = 0;

    [[nodiscard]] bool is_in(const LayerBounds& bounds) const {
        const auto height = static_cast<double>(height_m);
        return gate >= 0 && height >= bounds.bottom_m && height < bounds.top_m;
    }
};

class SweepCells {
  public:
    static constexpr std::size_t no_radial = static_cast<std::size_t>(-1);

    // Radials without gates of the moment, or without finite angles, see nothing.
    SweepCells(const level2::Sweep& sweep, const level2::SweepMoment& moment,
               const grid::BeamGeometry& beam);

    // Returns the index in the sweep of the radial that sees an azimuth of the layer, or no_radial.
    [[nodiscard]] std::size_t radial(std::size_t azimuth) const { return radials_[azimuth]; }
    [[nodiscard]] const ArcGate& gate(std::size_t arc) const { return gates_[arc]; }
    [[nodiscard]] bool is_empty() const { return radials_.empty(); }

  private:
    std::vector<std::size_t> radials_;  // of each azimuth, or empty
    std::vector<ArcGate> gates_;        // of each arc, or empty
};

// Returns the beams of a volume's antenna. If its position is unknown, the antenna is at sea level
// at 40 degrees north.
[[nodiscard]] grid::BeamGeometry beam_of(const level2::Volume& volume);

}  // namespace stormcellar::retrieve
