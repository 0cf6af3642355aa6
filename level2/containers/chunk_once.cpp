#include "level2/containers/chunk_once.h"

#include <algorithm>

#include "level2/containers/content.h"

namespace stormcellar::level2 {
namespace {

// The first bytes of a chunk are a volume header and the start of a record, or the start of a
// record with the checksum of its first block. No two chunks begin alike.
constexpr std::size_t sign_bytes = 32;

}  // namespace

std::span<const std::byte> chunk_once(std::span<const std::byte> bytes) {
    if (content_at_start(bytes) != Content::ldm) return bytes;
    while (bytes.size() > sign_bytes) {
        const auto sign = bytes.first(sign_bytes);
        const auto again =
            std::search(bytes.begin() + sign_bytes, bytes.end(), sign.begin(), sign.end());
        if (again == bytes.end()) return bytes;
        const auto length = static_cast<std::size_t>(again - bytes.begin());
        const auto first = bytes.first(length), rest = bytes.subspan(length);
        const std::size_t common = std::min(first.size(), rest.size());
        if (!std::ranges::equal(first.first(common), rest.first(common))) return bytes;
        if (rest.size() < first.size()) return first;
        bytes = rest;
    }
    return bytes;
}

}  // namespace stormcellar::level2
