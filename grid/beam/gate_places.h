// grid/beam/gate_places.h -- where the centres of a sweep's gates lie.
//
// For each gate a parabola through the places that it has at the sweep's elevation and half a beam
// below and above it: within 0.02 m of the beam model for radials up to half a beam off, ranges to
// 470 km, elevations of -5 to 60 degrees, 4/3 earth (enforced by tests/grid/gate_places_test.cpp).
// Threads: immutable.
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

    // Of a radial so much higher than the sweep; gates from 0 to the moment's stride. None where
    // the beam does not go.
    [[nodiscard]] std::optional<EarthPoint> at(std::int32_t gate, double offset_deg) const;

  private:
    // middle + halves * (linear + halves * square), halves being half beams off.
    struct Place {
        EarthPoint middle, linear, square;
    };
    double half_beam_deg_;
    std::vector<Place> places_;
};

}  // namespace stormcellar::grid
