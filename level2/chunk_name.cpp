#include "level2/chunk_name.h"

#include <algorithm>

#include <fmt/format.h>

namespace stormcellar::level2 {
namespace {

constexpr std::string_view volume_pattern = "dddddddd-dddddd-";  // d: a digit
constexpr std::size_t volume_length = 15;
constexpr std::size_t most_digits = 3;

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

bool is_volume(std::string_view text) {
    for (std::size_t i = 0; i < volume_pattern.size(); ++i) {
        if (volume_pattern[i] == 'd' ? !is_digit(text[i]) : text[i] != '-') return false;
    }
    return true;
}

std::optional<ChunkKind> kind_of(char letter) {
    switch (letter) {
        case 'S':
            return ChunkKind::start;
        case 'I':
            return ChunkKind::intermediate;
        case 'E':
            return ChunkKind::end;
        default:
            return std::nullopt;
    }
}

// "043-I", whatever follows; a number without leading zeros is as good.
std::optional<ChunkName> read_chunk(std::string_view text) {
    ChunkName chunk;
    std::size_t at = 0;
    for (; at < text.size() && at < most_digits && is_digit(text[at]); ++at)
        chunk.number = 10 * chunk.number + (text[at] - '0');
    if (chunk.number == 0 || at + 2 > text.size() || text[at] != '-') return std::nullopt;
    const auto kind = kind_of(text[at + 1]);
    if (!kind) return std::nullopt;
    at += 2;
    if (at < text.size() && text[at] != '-' && text[at] != '.' && text[at] != '_') {
        return std::nullopt;
    }
    chunk.kind = *kind;
    return chunk;
}

char letter_of(ChunkKind kind) {
    if (kind == ChunkKind::start) return 'S';
    return kind == ChunkKind::end ? 'E' : 'I';
}

}  // namespace

std::optional<ChunkName> parse_chunk_name(std::string_view path) {
    const std::string_view name = path.substr(path.rfind('/') + 1);
    for (std::size_t at = 0; at + volume_pattern.size() <= name.size(); ++at) {
        if (!is_volume(name.substr(at, volume_pattern.size()))) continue;
        if (at > 0 && is_digit(name[at - 1])) continue;
        auto chunk = read_chunk(name.substr(at + volume_pattern.size()));
        if (!chunk) continue;
        chunk->volume = name.substr(at, volume_length);
        return chunk;
    }
    return std::nullopt;
}

std::string to_string(const ChunkName& name) {
    return fmt::format("{}-{:03}-{}", name.volume, name.number, letter_of(name.kind));
}

}  // namespace stormcellar::level2
