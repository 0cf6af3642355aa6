#include "retrieve/derived/quality_note.h"

#include <charconv>
#include <string_view>
#include <system_error>

#include "retrieve/derived/quality_moment.h"
#include "stormcellar/retrieve/derived_moments.h"

namespace stormcellar::retrieve {
namespace {

// Returns the number at the start of a text, if `unit` follows.
std::optional<double> number_at_start(std::string_view text, std::string_view unit = "") {
    double number = 0;
    const auto read = std::from_chars(text.data(), text.data() + text.size(), number);
    const std::string_view rest = text.substr(static_cast<std::size_t>(read.ptr - text.data()));
    const bool is_good = read.ec == std::errc{} && rest.starts_with(unit);
    return is_good ? std::optional{number} : std::nullopt;
}

}  // namespace

std::optional<QualityNote> quality_note_in(std::span<const std::string> notes) {
    const std::string text = quality_in_notes(notes);
    if (text.empty()) return std::nullopt;
    const auto numbers = std::string_view(text).substr(quality_words.size());
    const auto least = number_at_start(numbers);
    if (!least) return std::nullopt;
    QualityNote note{*least, std::nullopt};
    constexpr std::string_view separator = "; ";
    const std::size_t at = numbers.find(separator);
    if (at == numbers.npos) return note;
    const auto percent = number_at_start(numbers.substr(at + separator.size()), " %");
    if (percent) note.share = *percent / 100;
    return note;
}

bool is_of_quality(std::span<const std::string> notes, double least) {
    const std::string text = quality_in_notes(notes);
    if (least <= 0 || text.empty()) return least <= 0 && text.empty();
    const std::string wanted = weather_note(least, {});  // without a share
    return text.starts_with(wanted) && (text.size() == wanted.size() || text[wanted.size()] == ';');
}

}  // namespace stormcellar::retrieve
