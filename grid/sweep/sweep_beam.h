// grid/sweep/sweep_beam.h -- a table of the heights of one sweep's beam over each arc from the
// radar.
//
// The table has the heights of the beam's center and edges every 500 m along the arc, and is linear
// in between.
//
// If a radial was measured higher or lower than its sweep, its beam is on the parabola through the
// center and the edges of the sweep's beam. An edge is lost if it never passes over an arc, or if
// it passes on the wrong side of the beam's center. Ducts and the ground cause this. A lost edge is
// replaced by the mirror image of the other edge. If both are lost, each is placed half a beam
// width (at the range of the center) from the center. So the whole beam rises per degree as the
// half whose edge is not lost does. Nothing is seen between the center and a lost edge.
//
// Threads   Immutable; many threads may use one object.
// Accuracy  grid/sweep/polar_sweep.h states it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "grid/beam/arc_table.h"
#include "stormcellar/grid/beam_model.h"

namespace stormcellar::grid {

// The height of a beam whose center never passes over an arc is above this.
inline constexpr float highest_beam_m = 1e8F;

// The heights of a beam's center, and of its edges at half a beam width from the center. Lost edges
// are replaced.
struct BeamHeights {
    float center_m = 0, lower_m = 0, upper_m = 0;
};

// The entry of the table for one arc.
struct BeamAtArc {
    BeamHeights heights;
    float gate_and_half = 0;  // GatePlace::number_and_half for radials of kind 0
};

class SweepBeam {
  public:
    // The table covers arcs from 0 to (table_size - 1) * ArcTable::step_m. `gates` is
    // SweepGates::first_table(), which is null for a sweep without gates.
    SweepBeam(const BeamModel& beam, double elevation_deg, double half_beam_deg,
              std::size_t table_size, const ArcTable* gates);

    [[nodiscard]] BeamAtArc at(ArcPlace place) const {
        const Lanes& here = table_[place.index];
        const Lanes& next = table_[place.index + 1];
        Lanes both;
        for (std::size_t i = 0; i < both.size(); ++i)
            both[i] = here[i] + place.fraction * (next[i] - here[i]);
        return {{both[0], both[1], both[2]}, both[3]};
    }
    [[nodiscard]] BeamHeights heights(ArcPlace place) const { return at(place).heights; }
    // Returns the heights of a beam that is `offset_deg` higher than the sweep's elevation.
    [[nodiscard]] BeamHeights heights(ArcPlace place, float offset_deg) const {
        return offset(heights(place), offset_deg);
    }
    [[nodiscard]] BeamHeights offset(const BeamHeights& sweep, float offset_deg) const {
        const float linear_m = (sweep.upper_m - sweep.lower_m) / 2;
        const float square_m = (sweep.upper_m + sweep.lower_m) / 2 - sweep.center_m;
        const auto at = [&](float halves) {
            return sweep.center_m + halves * (linear_m + halves * square_m);
        };
        const float halves = offset_deg * halves_per_deg_;
        return {at(halves), at(halves - 1), at(halves + 1)};
    }
    [[nodiscard]] float rise_m_per_deg(const BeamHeights& heights) const {
        return (heights.upper_m - heights.lower_m) / 2 * halves_per_deg_;
    }
    // Returns the part of the beam that is seen: a lost edge is at the center.
    [[nodiscard]] BeamHeights without_lost_edges(ArcPlace place, BeamHeights heights) const {
        if (lost_edges_.empty()) return heights;
        const unsigned lost = lost_edges_[place.index] | lost_edges_[place.index + 1];
        if ((lost & lost_lower) != 0) heights.lower_m = heights.center_m;
        if ((lost & lost_upper) != 0) heights.upper_m = heights.center_m;
        return heights;
    }

  private:
    // The members of a BeamAtArc, in order, so that the compiler can use one vector.
    using Lanes = std::array<float, 4>;
    static constexpr std::uint8_t lost_lower = 1, lost_upper = 2;

    float halves_per_deg_;                  // half beam widths in a degree
    std::vector<Lanes> table_;              // by arc, like an ArcTable
    std::vector<std::uint8_t> lost_edges_;  // by arc; empty if no edge is lost
};

}  // namespace stormcellar::grid
