// tests/fuzz/slow_expand.h -- expands Unix compress in the simplest way, as the reference for
// CompressStream.
//
// The table holds a whole string for each code; codes are cut from groups of eight.
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

// Expands a .Z file. Once the text has more than `limit` bytes, stops with CompressEnd::none.
[[nodiscard]] Expanded slow_expand(std::span<const std::byte> file, std::size_t limit);

}  // namespace stormcellar::fuzz
