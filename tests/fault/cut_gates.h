// tests/fault/cut_gates.h -- shortens volumes, so that many of them can be written quickly.
#pragma once

#include <cstdint>

#include "stormcellar/level2/volume.h"

namespace stormcellar::fault {

// Keeps the first `gates` gates of each radial of each moment of 8 bits, and no other moments. The
// volume must have at least this many.
void cut_gates(level2::Volume& volume, std::uint16_t gates);

}  // namespace stormcellar::fault
