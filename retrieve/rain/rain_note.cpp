#include "retrieve/rain/rain_note.h"

#include <string_view>

#include <fmt/format.h>

namespace stormcellar::retrieve {
namespace {

constexpr std::string_view rain_words = "rain since ";

}  // namespace

// The time and the span are followed by ": " and "; ", at which rain_in_notes() cuts.
std::string rain_note(const RainNote& note) {
    const std::string gap = note.gap_minutes >= 0.5
                                ? fmt::format(", {:.0f} of them without volumes", note.gap_minutes)
                                : std::string{};
    return fmt::format(
        "{}{}: {:.0f} minutes{}; {} volumes; {} columns were not seen for a part of "
        "the time",
        rain_words, format_utc(note.from), note.minutes, gap, note.volumes,
        note.columns_partly_unseen);
}

std::optional<RainFacts> rain_in_notes(std::span<const std::string> notes) {
    for (const std::string& note : notes) {
        const std::string_view text(note);
        const std::size_t colon = text.find(": "), end = text.find("; ");
        if (!text.starts_with(rain_words) || colon == text.npos || end == text.npos || end < colon)
            continue;
        const auto from =
            parse_utc(text.substr(rain_words.size(), colon - rain_words.size()), UtcTime{});
        if (!from) continue;
        return RainFacts{*from, std::string(text.substr(colon + 2, end - colon - 2))};
    }
    return std::nullopt;
}

}  // namespace stormcellar::retrieve
