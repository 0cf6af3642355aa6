// base/byte_size.h -- parses and writes amounts of bytes.
//
// Threads   Pure functions.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "stormcellar/base/result.h"

namespace stormcellar {

// Parses "20 GB", "1.5GiB" or "500000": a number and B, kB, MB, GB, TB (powers of 1000) or KiB,
// MiB, GiB, TiB (powers of 1024), in upper or lower case, with or without a space. A number without
// a unit means bytes. Fractions of a byte are dropped. Errors: bad_argument for anything else, and
// for 2^63 bytes or more.
[[nodiscard]] Result<std::uint64_t> parse_byte_size(std::string_view text);

// Writes a size for people, such as "12 B" or, with three digits, "1.25 GB".
[[nodiscard]] std::string format_byte_size(std::uint64_t bytes);

}  // namespace stormcellar
