// stormcellar/level2/volume_difference.h -- finds the first difference between two volumes.
//
// Threads   A pure function.
// Errors    None.
#pragma once

#include <string>

#include "stormcellar/level2/volume.h"

namespace stormcellar::level2 {

// Returns the first place where the volumes differ, such as "sweep 3, radial 17: azimuth", or an
// empty text if they are equal. Numbers are compared as bits: a NaN equals itself, and 0 does not
// equal -0. Indices count from 0.
[[nodiscard]] std::string difference(const Volume& a, const Volume& b);

}  // namespace stormcellar::level2
