// level2/containers/content.h -- recognizes the content of a file by its bytes.
//
// Threads   Pure functions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace stormcellar::level2 {

enum class Content : std::uint8_t {
    gzip,
    bzip2,     // a bzip2 stream at the start: a whole file
    compress,  // Unix compress, ".Z"
    ldm,       // LDM records, with or without a 24-byte header before them
    messages,  // uncompressed messages, with or without a 24-byte header before them
    unknown
};

// Reads only the start. A first frame that is not a message is allowed if messages follow it.
[[nodiscard]] Content content_at_start(std::span<const std::byte> bytes);

// Does the same, but if the start is damaged, searches all bytes for an LDM record or a message.
// The start of another format, such as PNG or the grids of a cache, is not damaged but unknown.
[[nodiscard]] Content content_anywhere(std::span<const std::byte> bytes);

}  // namespace stormcellar::level2
