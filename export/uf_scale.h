// export/uf_scale.h -- values as words of 16 bits, for UF; internal to export.
//
// A field has one factor for the whole volume: word = value * factor. If the values of the moment
// are whole multiples of one step, the factor makes every word exact; 100 is preferred, as most
// writers of UF use it. Otherwise (PHI) the factor is the largest that fits.
//
// Accuracy  Exact for scales and offsets of REF, VEL, SW, ZDR, RHO and CFP as radars send them. A
//           word of PHI is within 0.006 degrees of the value.
// Threads   Pure functions.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::netcdf {

// The word of a gate without a value, and of every header word that is unknown.
inline constexpr std::int16_t uf_missing = -32768;

// Returns the factor of a moment. Errors: unsupported if 16 bits cannot hold its values.
[[nodiscard]] Result<int> uf_factor(std::span<const level2::Sweep> sweeps, level2::Moment moment);

// Returns the word for each code of these gates.
[[nodiscard]] std::vector<std::int16_t> uf_words(const level2::SweepMoment& moment, int factor);

}  // namespace stormcellar::netcdf
