// stormcellar/level2/volume_difference.h -- whether two volumes are the same to the bit.
// Thread contract: a pure function.
#pragma once

#include <string>

#include "stormcellar/level2/volume.h"

namespace stormcellar::level2 {

// Where the volumes first differ, as "sweep 3, radial 17: azimuth"; empty when they do not. Numbers
// are compared as bits, so a NaN equals itself and 0 does not equal -0. Indices count from 0.
[[nodiscard]] std::string difference(const Volume& a, const Volume& b);

}  // namespace stormcellar::level2
