// level2/decode/late_radials.h -- finds the gap in a sweep where a late radial belongs.
//
// If two records come in the wrong order, they leave a gap in a sweep, and the radials that fill it
// come after newer radials. A late radial fits between two radials if the azimuth numbers leave a
// gap there and the times agree.
//
// Threads   Pure functions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "stormcellar/level2/volume.h"

namespace stormcellar::level2 {

// Returns true if the radial is older than `newer`, but by no more than 15 minutes, the longest
// volume.
[[nodiscard]] bool goes_back(const Radial& radial, UtcTime newer);

enum class LateFit : std::uint8_t { none, fills_gap, repeats };

// Returns `repeats` if the radial repeats radial number `at` of the sweep, `fills_gap` if it fits
// between `before` and radial number `at`, and otherwise `none`. If `before` is null, the gap is at
// the start of the sweep.
[[nodiscard]] LateFit fit_at(const Sweep& sweep, std::size_t at, const Radial* before,
                             const Radial& radial);

// Returns the index in the sweep at which the radial fits, or none.
[[nodiscard]] std::optional<std::size_t> place_of_late(const Sweep& sweep, const Radial& radial);

}  // namespace stormcellar::level2
