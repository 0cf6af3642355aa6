// retrieve/derived/rain_moments.h -- the moments KDP, specific differential phase, and RATE, rain
// rate.
//
// KDP has the gates and the flags of PHI, in steps of 0.005 degrees/km. A gate with a phase is
// ambiguous where no KDP can be fitted, and where KDP would exceed 160 degrees/km. RATE has the
// gates and the flags of REF, in steps of 0.02 mm/h up to 1300. A sweep without PHI takes KDP for
// its RATE from the nearest sweep that has PHI.
//
// Threads   Pure functions.
#pragma once

#include <span>

#include "stormcellar/level2/volume.h"

namespace stormcellar::retrieve {

// Adds KDP and RATE, each only if it is wanted.
void add_rain_moments(level2::Volume& volume, std::span<const level2::Moment> wanted);

}  // namespace stormcellar::retrieve
