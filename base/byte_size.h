// base/byte_size.h -- amounts of bytes as people write them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "stormcellar/base/result.h"

namespace stormcellar {

// "20 GB", "1.5GiB", "500000": a number and B, kB, MB, GB, TB (powers of 1000) or KiB, MiB, GiB,
// TiB (powers of 1024), in letters of either case, with or without a space; no unit: bytes. Parts
// of a byte are dropped. bad_argument for anything else and for 2^63 bytes or more.
[[nodiscard]] Result<std::uint64_t> parse_byte_size(std::string_view text);

// "1.25 GB": three digits or more, for reading and not for parsing back.
[[nodiscard]] std::string format_byte_size(std::uint64_t bytes);

}  // namespace stormcellar
