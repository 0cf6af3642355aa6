// tests/fuzz/slow_expand.h -- Unix compress in the simplest way, as the reference for
// CompressStream.
//
// Every entry of the table is a string of its own; codes are cut from groups of eight.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "level2/containers/compress_stream.h"

namespace stormcellar::fuzz {

struct Expanded {
    std::string text;
    level2::CompressEnd end = level2::CompressEnd::none;
};

// Stops, with end none, once there are more than `limit` bytes.
[[nodiscard]] Expanded slow_expand(std::span<const std::byte> file, std::size_t limit);

}  // namespace stormcellar::fuzz
