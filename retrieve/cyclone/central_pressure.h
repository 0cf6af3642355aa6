// retrieve/cyclone/central_pressure.h -- the fall of pressure from the outermost ring to the center
// of a hurricane in gradient wind balance, dp/dr = density (V^2 / r + f V).
//
// Units     hPa. The pressure is at the height of the beam.
// Errors    The errors of all rings count as one, because most of each is common to all rings. The
//           density of the standard atmosphere adds 5 %.
// Threads   Pure.
#pragma once

#include <span>

#include "stormcellar/retrieve/cyclone.h"

namespace stormcellar::retrieve {

// Integrates inward from the outermost ring; inside the innermost ring, the wind falls to 0 in
// proportion to the radius. Returns 0 without rings.
[[nodiscard]] Estimate pressure_deficit_hpa(std::span<const CycloneRing> rings, double latitude_deg,
                                            double altitude_m);

}  // namespace stormcellar::retrieve
