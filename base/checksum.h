// base/checksum.h -- the two checksums that this project writes and compares.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace stormcellar {

// XXH3, 64 bits, seed 0 (xxHash 0.8): guards our own files and detects changed raw files.
[[nodiscard]] std::uint64_t xxh3_64(std::span<const std::byte> bytes);

// CRC-32 as in zlib, to be continued from a previous value (start with 0).
[[nodiscard]] std::uint32_t crc32(std::span<const std::byte> bytes, std::uint32_t previous = 0);

}  // namespace stormcellar
