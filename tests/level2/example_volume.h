// tests/level2/example_volume.h -- a volume made by hand, for tests of the writer.
#pragma once

#include <cstddef>
#include <cstdint>

#include "stormcellar/level2/volume.h"

namespace stormcellar::level2 {

// Returns rows of `gates` codes of 8 or 16 bits, in which every code occurs.
[[nodiscard]] SweepMoment moment_of(Moment name, std::size_t radials, std::int32_t gates, int bits);

// Returns two sweeps that use every field of the model that message 31 has.
[[nodiscard]] Volume example_volume();

}  // namespace stormcellar::level2
