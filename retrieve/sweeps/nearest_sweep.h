// retrieve/sweeps/nearest_sweep.h -- finds the sweeps and radials that observe the same place.
//
// A Doppler cut lacks dual polarization, and a surveillance cut lacks velocities, so that a gate
// needs a companion in another sweep.
//
// Units     Degrees.
// Threads   Pure functions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "stormcellar/level2/volume.h"

namespace stormcellar::retrieve {

// Returns the sweep that has the moment: `sweep` itself, or else the sweep of nearest elevation, at
// most 0.3 degrees away. Of sweeps within a tenth of a degree of each other, the sweep nearest to
// `sweep` in the order of the volume counts. `elevation_deg` is the elevation of `sweep`.
[[nodiscard]] std::optional<std::size_t> companion_sweep(const level2::Volume& volume,
                                                         std::size_t sweep, double elevation_deg,
                                                         level2::Moment moment);

// Returns the next sweep with reflectivity at least 0.3 degrees above. Of sweeps within 0.2 degrees
// of each other, the sweep with most radials and the longest range counts.
[[nodiscard]] std::optional<std::size_t> sweep_above(const level2::Volume& volume,
                                                     std::size_t sweep);

// Returns for each azimuth the number of the sweep's radial nearest to it, or -1 if no radial is
// within about a degree.
[[nodiscard]] std::vector<std::int32_t> nearest_radials(std::span<const float> azimuths_deg,
                                                        const level2::Sweep& sweep);

// Returns the azimuths of a sweep's radials.
[[nodiscard]] std::vector<float> azimuths_of(const level2::Sweep& sweep);

}  // namespace stormcellar::retrieve
