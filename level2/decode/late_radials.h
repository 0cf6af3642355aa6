// level2/decode/late_radials.h -- finds the gap of a sweep that a late radial belongs in.
//
// If two records come in the wrong order, they leave a gap in a sweep, and the radials that fill it
// come after newer radials. A gap is a gap in the radials' numbers, and the times on both sides
// must agree.
//
// Threads   Pure functions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "stormcellar/level2/volume.h"

namespace stormcellar::level2 {

// Returns true if the radial is older than `newer`, by no more than a volume lasts.
[[nodiscard]] bool goes_back(const Radial& radial, UtcTime newer);

enum class LateFit : std::uint8_t { none, fills_gap, repeats };

// Returns how a radial fits into a sweep: it repeats the radial `at`, or belongs between that
// radial and `before` (null: nothing is before it).
[[nodiscard]] LateFit fit_at(const Sweep& sweep, std::size_t at, const Radial* before,
                             const Radial& radial);

// Returns the place in the sweep where the radial fits, or none.
[[nodiscard]] std::optional<std::size_t> place_of_late(const Sweep& sweep, const Radial& radial);

}  // namespace stormcellar::level2
