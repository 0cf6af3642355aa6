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
    bzip2,     // a file that bzip2 compressed as a whole
    compress,  // Unix compress, ".Z"
    ldm,       // LDM records, with or without a 24-byte header before them
    messages,  // uncompressed messages, with or without a 24-byte header before them
    unknown
};

// Judges the content by its start alone. Also returns `messages` if the first frame is not a
// message but a message surely follows it.
[[nodiscard]] Content content_at_start(std::span<const std::byte> bytes);

// Returns content_at_start(). If that is `unknown`, searches all bytes for an LDM record or a
// message. For the start of another format, such as PNG or a grid file, returns `unknown` without a
// search.
[[nodiscard]] Content content_anywhere(std::span<const std::byte> bytes);

}  // namespace stormcellar::level2
