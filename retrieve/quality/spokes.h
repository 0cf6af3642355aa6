// retrieve/quality/spokes.h -- radials that another transmitter or the sun fills with echo.
//
// Method    Radials are cut into bins of 5 km. Interference is a run of at least 60 km of bins that
//           are full of echo in one to three radials, and empty in the second radial to either side
//           of these radials. A sun spike is a radial within 1.5 degrees of the sun. In at least 40
//           km of its bins, the power (the reflectivity less 20 log r) is the same within 6 dB.
// Accuracy  tests/retrieve/spokes_test.cpp: finds 90 % of the gates of synthetic interference, 95 %
//           of a synthetic sun spike, and two real sun spikes within 1.2 degrees of the sun.
// Not covered  Spokes in dense echo, spokes wider than three radials, and short or broken spokes
//           (pulses of other radars).
// Threads   Pure functions.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "retrieve/quality/gate_field.h"
#include "retrieve/quality/sun_position.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::retrieve {

enum class Spoke : std::uint8_t { none, interference, sun };

// Returns the kind of each gate of a reflectivity moment of the sweep, radials x gates. Empty if
// there is no spoke. `sun` is the position of the sun at the time of the sweep, or none if unknown.
[[nodiscard]] std::vector<Spoke> find_spokes(const GateField& field, const level2::Sweep& sweep,
                                             const std::optional<SunPosition>& sun);

}  // namespace stormcellar::retrieve
