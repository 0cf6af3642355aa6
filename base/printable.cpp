#include "base/printable.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace stormcellar {
namespace {

// Returns the code point of one well-formed character.
char32_t code_point(std::string_view character) {
    const auto lead = static_cast<unsigned char>(character.front());
    if (character.size() == 1) return lead;
    char32_t code = lead & (0x7FU >> character.size());
    for (const char c : character.substr(1))
        code = (code << 6U) | (static_cast<unsigned char>(c) & 0x3FU);
    return code;
}

struct CodePoints {
    char32_t first, last;
};

// The characters that printable() escapes: control characters; the separators of lines and
// paragraphs; the marks of interlinear annotation; and the characters that Unicode ignores by
// default, because no glyph shows them (DerivedCoreProperties.txt 15.0,
// Default_Ignorable_Code_Point). The ignored characters include every control of direction,
// zero-width characters, variation selectors and tags.
constexpr std::array<CodePoints, 20> unseen = {{
    {0x0000, 0x001F}, {0x007F, 0x009F}, {0x00AD, 0x00AD},   {0x034F, 0x034F},   {0x061C, 0x061C},
    {0x115F, 0x1160}, {0x17B4, 0x17B5}, {0x180B, 0x180F},   {0x200B, 0x200F},   {0x2028, 0x2029},
    {0x202A, 0x202E}, {0x2060, 0x206F}, {0x3164, 0x3164},   {0xFE00, 0xFE0F},   {0xFEFF, 0xFEFF},
    {0xFFA0, 0xFFA0}, {0xFFF0, 0xFFFB}, {0x1BCA0, 0x1BCA3}, {0x1D173, 0x1D17A}, {0xE0000, 0xE0FFF},
}};

bool is_seen(char32_t code) {
    return std::none_of(unseen.begin(), unseen.end(), [&](const CodePoints& range) {
        return code >= range.first && code <= range.last;
    });
}

}  // namespace

std::size_t utf8_length(std::string_view text) {
    const auto lead = static_cast<unsigned char>(text.front());
    std::size_t length = 0;
    if (lead < 0x80) {
        length = 1;
    } else if (lead >= 0xC2 && lead < 0xE0) {
        length = 2;
    } else if (lead >= 0xE0 && lead < 0xF0) {
        length = 3;
    } else if (lead >= 0xF0 && lead < 0xF5) {
        length = 4;
    }
    if (length == 0 || length > text.size()) return 0;
    // The character must not be overlong, a surrogate, or beyond U+10FFFF (RFC 3629 section 4).
    if (length > 1) {
        const auto second = static_cast<unsigned char>(text[1]);
        if ((lead == 0xE0 && second < 0xA0) || (lead == 0xED && second >= 0xA0) ||
            (lead == 0xF0 && second < 0x90) || (lead == 0xF4 && second >= 0x90)) {
            return 0;
        }
    }
    for (const char c : text.substr(1, length - 1)) {
        if ((static_cast<unsigned char>(c) & 0xC0U) != 0x80U) return 0;
    }
    return length;
}

std::string printable(std::string_view text) {
    std::string safe;
    while (!text.empty()) {
        const std::size_t length = utf8_length(text);
        const std::string_view character = text.substr(0, std::max<std::size_t>(length, 1));
        if (length > 0 && is_seen(code_point(character))) {
            safe += character;
        } else {
            for (const char c : character)
                safe += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
        }
        text.remove_prefix(character.size());
    }
    return safe;
}

}  // namespace stormcellar
