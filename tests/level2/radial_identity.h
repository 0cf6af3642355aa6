// tests/level2/radial_identity.h -- computes one number from all contents of a radial.
//
// Two radials have the same identity if they are the same to the bit: every field, the elevation
// number and message type of their sweep, and for every moment its geometry, scale, offset and the
// codes of all gates. Facts that a sweep takes from its first radial alone (azimuth spacing,
// thresholds, control flags) and the angle of the VCP do not count.
#pragma once

#include <cstdint>
#include <vector>

#include "stormcellar/level2/volume.h"

namespace stormcellar::level2 {

using RadialIdentity = std::uint64_t;  // XXH3: two of 10,000 radials agree by chance in 1 of 10^11

// Returns the identities of the radials in file order.
[[nodiscard]] std::vector<RadialIdentity> identities(const Volume& volume);
[[nodiscard]] RadialIdentity identity(const Sweep& sweep, std::size_t radial);

}  // namespace stormcellar::level2
