// tests/level2/grow_dropping.h -- decodes a file as it grows, and frees its sweeps early.
#pragma once

#include <cstddef>
#include <span>

#include "stormcellar/level2/decode.h"

namespace stormcellar::level2 {

// Appends pieces of random length up to `most` bytes, and moves sweeps out of the volume as soon as
// they may be dropped, until the end.
[[nodiscard]] Result<Decoded> grow_dropping(std::span<const std::byte> bytes, std::size_t most,
                                            unsigned seed);

}  // namespace stormcellar::level2
