// retrieve/derived/shear_moments.h -- makes the moments AZSH and DIVG of a volume that has VELD.
//
// stormcellar/retrieve/derived_moments.h is the contract.
//
// Threads   Pure functions.
#pragma once

#include <span>

#include "stormcellar/base/result.h"
#include "stormcellar/level2/volume.h"
#include "stormcellar/retrieve/dealias.h"

namespace stormcellar::retrieve {

// Adds the wanted moments of shear at the end of each sweep with VELD. `dealiased` has the fold
// numbers of this volume. Returns true if a moment of shear was wanted. Errors: those of
// sweep_shear().
[[nodiscard]] Result<bool> add_shear_moments(level2::Volume& volume, const Dealiased& dealiased,
                                             std::span<const level2::Moment> wanted);

}  // namespace stormcellar::retrieve
