#include "level2/chunk_name.h"

#include <algorithm>

#include <fmt/format.h>

namespace stormcellar::level2 {
namespace {

constexpr std::string_view pattern = "dddddddd-dddddd-ddd-k";  // d: a digit, k: the kind
constexpr std::size_t volume_length = 15;
constexpr std::size_t number_at = 16;

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

bool matches(std::string_view text) {
    for (std::size_t i = 0; i < pattern.size(); ++i) {
        const char c = text[i];
        if (pattern[i] == 'd' && !is_digit(c)) return false;
        if (pattern[i] == '-' && c != '-') return false;
        if (pattern[i] == 'k' && c != 'S' && c != 'I' && c != 'E') return false;
    }
    return true;
}

char letter_of(ChunkKind kind) {
    if (kind == ChunkKind::start) return 'S';
    return kind == ChunkKind::end ? 'E' : 'I';
}

}  // namespace

std::optional<ChunkName> parse_chunk_name(std::string_view path) {
    const std::string_view name = path.substr(path.rfind('/') + 1);
    for (std::size_t at = 0; at + pattern.size() <= name.size(); ++at) {
        const std::string_view text = name.substr(at, pattern.size());
        if (!matches(text)) continue;
        if (at > 0 && is_digit(name[at - 1])) continue;
        const std::size_t end = at + pattern.size();
        if (end < name.size() && name[end] != '-' && name[end] != '.' && name[end] != '_') continue;
        ChunkName chunk;
        chunk.volume = text.substr(0, volume_length);
        for (const char digit : text.substr(number_at, 3))
            chunk.number = 10 * chunk.number + (digit - '0');
        if (text.back() == 'S') chunk.kind = ChunkKind::start;
        if (text.back() == 'E') chunk.kind = ChunkKind::end;
        if (chunk.number > 0) return chunk;
    }
    return std::nullopt;
}

std::string to_string(const ChunkName& name) {
    return fmt::format("{}-{:03}-{}", name.volume, name.number, letter_of(name.kind));
}

}  // namespace stormcellar::level2
