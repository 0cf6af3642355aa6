// tests/level2/example_volume.h -- makes a volume by hand, for tests of the writer.
#pragma once

#include <cstddef>
#include <cstdint>

#include "stormcellar/level2/volume.h"

namespace stormcellar::level2 {

// Returns a moment with `radials` rows of `gates` codes of `bits` bits (8 or 16). A large moment
// contains every code.
[[nodiscard]] SweepMoment moment_of(Moment name, std::size_t radials, std::int32_t gates, int bits);

// Returns a volume of two sweeps. It uses every field that message 31 fills.
[[nodiscard]] Volume example_volume();

}  // namespace stormcellar::level2
