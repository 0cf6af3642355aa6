// bunzip/bzip2_checksum.h -- the checksum of bzip2: CRC-32 with the polynomial 04C11DB7, the
// highest bit first, begun with and at the end combined with FFFFFFFF.
//
// Thread contract: pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "bunzip/paths.h"

namespace stormcellar::bunzip {

inline constexpr std::uint32_t checksum_begin = 0xFFFFFFFF;
// Goes on from `state`; the checksum is the state's complement.
using Checksum = std::uint32_t (*)(std::uint32_t state, std::span<const std::uint8_t> bytes);
[[nodiscard]] Checksum checksum_by(Path path);

}  // namespace stormcellar::bunzip
