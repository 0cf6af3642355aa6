// level2/containers/content.h -- what bytes hold, told from the bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace stormcellar::level2 {

enum class Content : std::uint8_t {
    gzip,
    bzip2,     // a bzip2 stream at the start: a whole file
    compress,  // Unix compress, ".Z"
    ldm,       // LDM records, behind a 24-byte header or not
    messages,  // uncompressed messages, behind a 24-byte header or not
    unknown
};

// Looks at the start only. A first frame that is no message is allowed if messages follow it.
[[nodiscard]] Content content_at_start(std::span<const std::byte> bytes);

// As above; where the start is damaged, looks through all of it for an LDM record or a message.
[[nodiscard]] Content content_anywhere(std::span<const std::byte> bytes);

}  // namespace stormcellar::level2
