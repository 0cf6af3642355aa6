// bunzip/bzip2_checksum.h -- computes the checksum of bzip2, which is CRC-32 with the polynomial
// 04C11DB7, the highest bit first. The state begins as FFFFFFFF, and all bits are inverted at the
// end.
//
// Threads   Pure functions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "bunzip/paths.h"

namespace stormcellar::bunzip {

inline constexpr std::uint32_t checksum_begin = 0xFFFFFFFF;
// Returns the state after `bytes`, continuing from `state`. The checksum is the complement of the
// last state.
using Checksum = std::uint32_t (*)(std::uint32_t state, std::span<const std::uint8_t> bytes);
[[nodiscard]] Checksum checksum_by(Path path);

}  // namespace stormcellar::bunzip
