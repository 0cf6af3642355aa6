// tests/level2/grow_dropping.h -- decodes a file while it grows, and drops its sweeps as early as
// possible.
#pragma once

#include <cstddef>
#include <span>

#include "stormcellar/level2/decode.h"

namespace stormcellar::level2 {

// Appends pieces of random length up to `most` bytes, drops each sweep as soon as that is allowed,
// puts all sweeps back, and finishes the volume.
[[nodiscard]] Result<Decoded> grow_dropping(std::span<const std::byte> bytes, std::size_t most,
                                            unsigned seed);

}  // namespace stormcellar::level2
