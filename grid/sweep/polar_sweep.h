// grid/sweep/polar_sweep.h -- one sweep of a moment, prepared for sampling at many columns.
//
// Numbers that depend only on the arc (the number of the gate, the height of the beam) are in
// tables with a step of 500 m, and are linear in between. The elevation of the sweep, and not that
// of the radial, places the gates.
//
// Units     Values are in the unit of the moment, or in mm^6/m^3 (Averaging::in_z, reflectivity
//           only).
// Threads   Immutable; many threads may use one object. The volume must outlive it.
// Accuracy  Enforced by tests/grid/polar_sweep_test.cpp for elevations of -5 to 60 degrees.
//             tables   0.15 m in range and height within 500 km, for the 4/3 earth and for rays
//                      through the reference atmosphere (profiles with kinks:
//                      stormcellar/grid/beam_model.h)
//             radials  up to half a beam off: the center within 0.25 m of the 4/3 earth, the edges
//                      within 1 m, for beams of 0.95 degrees within 470 km and below 21 km
#pragma once

#include <optional>

#include "grid/sweep/azimuth_table.h"
#include "grid/sweep/sweep_beam.h"
#include "grid/sweep/sweep_gates.h"
#include "stormcellar/grid/tile.h"

namespace stormcellar::grid {

class PolarSweep {
  public:
    PolarSweep(const level2::Sweep& sweep, const ChosenSweep& chosen, const BeamModel& beam,
               const PolarSweepOptions& options);

    [[nodiscard]] const SweepGates& gates() const { return gates_; }
    [[nodiscard]] const SweepBeam& beam() const { return beam_; }
    [[nodiscard]] const AzimuthTable& azimuths() const { return azimuths_; }

    // Returns the position of the nearest radial among the used radials, or AzimuthTable::none.
    [[nodiscard]] int radial_at(float azimuth_deg) const { return azimuths_.find(azimuth_deg); }
    // Returns the heights of the beam of the radial at `position`. For AzimuthTable::none, returns
    // the heights at the sweep's elevation.
    [[nodiscard]] BeamHeights heights_at(int position, ArcPlace place) const {
        const BeamHeights sweep = beam_.heights(place);
        if (position == AzimuthTable::none) return sweep;
        return beam_.offset(sweep, gates_.elevation_offset_deg(position));
    }
    // Returns the nearest gate of the radial at `position`.
    [[nodiscard]] Sample sample(int position, ArcPlace place) const {
        return sample(position, place, beam_.at(place));
    }
    [[nodiscard]] Sample sample(float azimuth_deg, ArcPlace place) const {
        return sample(radial_at(azimuth_deg), place);
    }
    // Returns the nearest gate of the radial at `position`. For callers that already have `beam`,
    // which must be beam().at(place).
    [[nodiscard]] Sample sample(int position, ArcPlace place, const BeamAtArc& beam) const {
        return gates_.sample(position, place, beam.gate_and_half);
    }
    // Returns the status of all samples within the bounds if all are no echo, or all are not seen;
    // else returns none. The status also holds for mixtures, although these take a gate and a
    // radial beyond the bounds.
    [[nodiscard]] std::optional<CellStatus> uniform_status(const PolarBounds& bounds) const;

  private:
    SweepGates gates_;
    SweepBeam beam_;
    AzimuthTable azimuths_;  // of the radials at positions in gates_
};

}  // namespace stormcellar::grid
