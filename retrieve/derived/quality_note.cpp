#include "retrieve/derived/quality_note.h"

#include <charconv>
#include <system_error>

#include "retrieve/derived/quality_moment.h"
#include "stormcellar/retrieve/derived_moments.h"

namespace stormcellar::retrieve {
namespace {

std::optional<double> number_at_start(std::string_view text) {
    double number = 0;
    const auto read = std::from_chars(text.data(), text.data() + text.size(), number);
    return read.ec == std::errc{} ? std::optional{number} : std::nullopt;
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
    const auto percent = number_at_start(numbers.substr(at + separator.size()));
    if (percent) note.share = *percent / 100;
    return note;
}

}  // namespace stormcellar::retrieve
