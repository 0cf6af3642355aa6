// level2/containers/content.h -- finds out from the bytes what they hold.
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

// Looks only at the start. A first frame that is not a message is allowed if messages follow it.
[[nodiscard]] Content content_at_start(std::span<const std::byte> bytes);

// The same, but if the start is damaged, searches all of it for an LDM record or a message. A start
// that is another format's, such as PNG's or that of a cache's grids, is not damaged: unknown.
[[nodiscard]] Content content_anywhere(std::span<const std::byte> bytes);

}  // namespace stormcellar::level2
