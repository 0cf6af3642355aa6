// tests/fault/cut_gates.h -- volumes cut short, so that many of them are written quickly.
#pragma once

#include <cstdint>

#include "stormcellar/level2/volume.h"

namespace stormcellar::fault {

// Leaves the first `gates` gates of each radial of each moment of 8 bits, and no others. It must
// have so many.
void cut_gates(level2::Volume& volume, std::uint16_t gates);

}  // namespace stormcellar::fault
