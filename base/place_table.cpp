#include "base/place_table.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <vector>

// The assembler puts the table into the program, so no file is read. clang-format off
asm(R"(
    .pushsection .rodata
    .hidden stormcellar_places_begin
    .globl stormcellar_places_begin
stormcellar_places_begin:
    .incbin ")" STORMCELLAR_PLACES R"("
    .hidden stormcellar_places_end
    .globl stormcellar_places_end
stormcellar_places_end:
    .byte 0
    .popsection
)");
// clang-format on

extern "C" {
extern const char stormcellar_places_begin[];
extern const char stormcellar_places_end[];
}

namespace stormcellar {
namespace {

// Removes and returns the text up to the separator, or the whole text if it has no separator.
std::string_view take(std::string_view& text, char separator) {
    const std::size_t end = std::min(text.find(separator), text.size());
    const std::string_view taken = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    return taken;
}

template <class Number>
Number number(std::string_view text) {
    Number value = 0;
    std::from_chars(text.data(), text.data() + text.size(), value);
    return value;
}

std::vector<NamedPlace> read_places() {
    std::vector<NamedPlace> places;
    std::string_view text(
        stormcellar_places_begin,
        static_cast<std::size_t>(stormcellar_places_end - stormcellar_places_begin));
    while (!text.empty()) {
        std::string_view line = take(text, '\n');
        if (line.empty() || line.front() == '#') continue;
        NamedPlace place;
        place.name = take(line, '\t');
        place.region = take(line, '\t');
        place.latitude_deg = number<double>(take(line, '\t'));
        place.longitude_deg = number<double>(take(line, '\t'));
        place.population_thousands = number<int>(take(line, '\t'));
        places.push_back(place);
    }
    return places;
}

// Returns the base letter of U+00C0 to U+00FF; `second` is the second byte in UTF-8.
char without_accent(unsigned char second) {
    static constexpr std::string_view letters =
        "aaaaaaaceeeeiiiidnooooo ouuuuytsaaaaaaaceeeeiiiidnooooo ouuuuyty";
    return second < 0x80 || second > 0xBF ? ' ' : letters[second - 0x80U];
}

}  // namespace

std::span<const NamedPlace> all_places() {
    static const std::vector<NamedPlace> places = read_places();
    return places;
}

std::string compared_name(std::string_view name) {
    constexpr unsigned char latin_1 = 0xC3;
    std::string compared;
    for (std::size_t i = 0; i < name.size(); ++i) {
        auto c = static_cast<unsigned char>(name[i]);
        if (c == latin_1 && i + 1 < name.size())
            c = static_cast<unsigned char>(without_accent(static_cast<unsigned char>(name[++i])));
        if (c == '.' || c == '\'' || c == '`') continue;
        const bool parts = std::isspace(c) != 0 || c == '-';
        if (parts && (compared.empty() || compared.back() == ' ')) continue;
        compared += parts ? ' ' : static_cast<char>(std::tolower(c));
    }
    if (!compared.empty() && compared.back() == ' ') compared.pop_back();
    if (compared.starts_with("saint ")) compared.replace(0, 5, "st");
    return compared;
}

}  // namespace stormcellar
