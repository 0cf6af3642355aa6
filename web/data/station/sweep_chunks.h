// web/data/station/sweep_chunks.h -- makes the chunks of one sweep at its place.
//
// A place has a regular axis of azimuths, 0.25, 0.75 ... or 0.5, 1.5 ... degrees. Each azimuth has
// the gates of the nearest radial, unless that is farther away than 0.75 of the spacing. An azimuth
// without a radial so near has no values, and its states are no_data. The bytes are uncompressed
// and little-endian, one row for each azimuth.
//
// Units     Those of the moment; degrees; m/s; milliseconds since 1970 UTC.
// Threads   Pure functions.
// Errors    None.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "stormcellar/level2/volume.h"
#include "web/data/station/sweep_places.h"

namespace stormcellar::web {

// The time of an azimuth without a radial; numpy and xarray read it as "not a time".
inline constexpr std::int64_t no_time_ms = std::numeric_limits<std::int64_t>::min();

[[nodiscard]] std::vector<double> azimuths_of(const SweepPlace& place);
// Returns the index of the radial of each azimuth; -1: none.
[[nodiscard]] std::vector<int> radials_of(const level2::Sweep& sweep, const SweepPlace& place);

// Return the values (float32, NaN: none) or the states (uint8, level2::GateStatus) of a moment.
// Return none if the sweep lacks the moment, or if its gates do not fit to the axis of the place.
// Gates beyond the axis are left out.
[[nodiscard]] std::optional<std::string> sweep_values(const level2::Sweep& sweep,
                                                      const SweepPlace& place,
                                                      const PlacedMoment& moment);
[[nodiscard]] std::optional<std::string> sweep_states(const level2::Sweep& sweep,
                                                      const SweepPlace& place,
                                                      const PlacedMoment& moment);

// The facts of radials: `time` as int64 (no_time_ms: none), the others as float32 (NaN: none).
enum class RadialFact { time, azimuth, elevation, nyquist };
[[nodiscard]] std::string radial_facts(const level2::Sweep& sweep, const SweepPlace& place,
                                       RadialFact fact);

}  // namespace stormcellar::web
