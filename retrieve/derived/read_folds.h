// retrieve/derived/read_folds.h -- reads fold numbers back from a volume that has VELD.
//
// Threads  Pure functions.
#pragma once

#include "stormcellar/level2/volume.h"
#include "stormcellar/retrieve/dealias.h"

namespace stormcellar::retrieve {

// Returns the fold numbers of all velocity moments, as dealias() found them. A gate is ambiguous if
// VELD marks it as ambiguous. Without VELD, all gates are ambiguous. Counts are 0.
[[nodiscard]] Dealiased read_folds(const level2::Volume& volume);

}  // namespace stormcellar::retrieve
