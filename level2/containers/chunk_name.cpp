#include "stormcellar/level2/chunk_name.h"

#include <utility>

#include <fmt/format.h>

namespace stormcellar::level2 {
namespace {

// Patterns of names: d is a digit, s a separator.
constexpr std::string_view dashed_volume = "dddddddd-dddddd-";
constexpr std::string_view key_time = "dddddddddddddds";
constexpr std::size_t most_digits = 3;

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

bool is_separator(char c) {
    return c == '-' || c == '_' || c == '.' || c == ':' || c == '+' || c == ',' || c == ' ' ||
           c == '=' || c == '@' || c == '%' || c == '~';
}

bool begins_as(std::string_view pattern, std::string_view text) {
    if (text.size() < pattern.size()) return false;
    for (std::size_t i = 0; i < pattern.size(); ++i) {
        const bool fits = pattern[i] == 'd'   ? is_digit(text[i])
                          : pattern[i] == 's' ? is_separator(text[i])
                                              : text[i] == pattern[i];
        if (!fits) return false;
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

// Reads a number from 1 to 999 at `at`, and moves `at` past it. Returns 0 if there is none.
int read_number(std::string_view text, std::size_t& at) {
    int number = 0;
    for (std::size_t digits = 0; digits < most_digits && at < text.size() && is_digit(text[at]);
         ++digits, ++at)
        number = 10 * number + (text[at] - '0');
    return number;
}

// Reads a part such as "043-I" at `number_at`; anything may follow after a separator. The number
// may lack its leading zeros.
std::optional<PlacedChunkName> read_chunk(std::string_view name, std::size_t number_at) {
    PlacedChunkName chunk;
    chunk.number_at = number_at;
    std::size_t at = number_at;
    chunk.name.number = read_number(name, at);
    if (chunk.name.number == 0 || at + 2 > name.size() || !is_separator(name[at])) {
        return std::nullopt;
    }
    const auto kind = kind_of(name[at + 1]);
    if (!kind) return std::nullopt;
    at += 2;
    if (at < name.size() && !is_separator(name[at])) return std::nullopt;
    chunk.name.kind = *kind;
    chunk.behind = at;
    return chunk;
}

// Returns the place where the number of the chunk begins, if the volume's part of a name is at
// `at`.
std::optional<std::size_t> number_behind_volume(std::string_view name, std::size_t at) {
    const std::string_view rest = name.substr(at);
    if (begins_as(dashed_volume, rest)) return at + dashed_volume.size();
    if (!begins_as(key_time, rest)) return std::nullopt;
    std::size_t behind = at + key_time.size();
    if (read_number(name, behind) == 0) return std::nullopt;
    if (behind == name.size() || !is_separator(name[behind])) return std::nullopt;
    return behind + 1;
}

char letter_of(ChunkKind kind) {
    if (kind == ChunkKind::start) return 'S';
    return kind == ChunkKind::end ? 'E' : 'I';
}

}  // namespace

std::optional<PlacedChunkName> place_chunk_name(std::string_view path) {
    const std::size_t directory = path.rfind('/') + 1;
    const std::string_view name = path.substr(directory);
    for (std::size_t at = 0; at < name.size(); ++at) {
        if (at > 0 && is_digit(name[at - 1])) continue;
        const auto number_at = number_behind_volume(name, at);
        if (!number_at) continue;
        auto chunk = read_chunk(name, *number_at);
        if (!chunk) continue;
        chunk->name.volume = name.substr(at, *number_at - 1 - at);
        chunk->number_at += directory;
        chunk->behind += directory;
        return chunk;
    }
    return std::nullopt;
}

std::optional<ChunkName> parse_chunk_name(std::string_view path) {
    auto placed = place_chunk_name(path);
    if (!placed) return std::nullopt;
    return std::move(placed->name);
}

std::string to_string(const ChunkName& name) {
    return fmt::format("{}-{:03}-{}", name.volume, name.number, letter_of(name.kind));
}

}  // namespace stormcellar::level2
