// grid/beam/gate_places.h -- computes where the centers of a sweep's gates are.
//
// The place of a gate is a function of the elevation: a parabola through three places, which are at
// the sweep's elevation, half a beam below it, and half a beam above it.
//
// Accuracy  0.02 m from the beam model, for radials up to half a beam off the sweep, ranges to
//           470 km, elevations of -5 to 60 degrees and the 4/3 earth (enforced by
//           tests/grid/gate_places_test.cpp).
// Threads   Immutable.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "stormcellar/grid/beam_model.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::grid {

class GatePlaces {
  public:
    GatePlaces(const level2::SweepMoment& moment, const BeamModel& beam, double elevation_deg,
               double half_beam_deg);

    // Returns the place of a gate of a radial that is `offset_deg` higher than the sweep. The gate
    // must be at least 0 and below the moment's stride. Returns none if the beam does not reach the
    // gate.
    [[nodiscard]] std::optional<EarthPoint> at(std::int32_t gate, double offset_deg) const;

  private:
    // The place is middle + h * (linear + h * square), where h is offset_deg divided by half the
    // beam width.
    struct Place {
        EarthPoint middle, linear, square;
    };
    double half_beam_deg_;
    std::vector<Place> places_;
};

}  // namespace stormcellar::grid
