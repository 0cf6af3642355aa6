#include "retrieve/nowcast/nowcast_note.h"

#include <string_view>

#include <fmt/format.h>

namespace stormcellar::retrieve {
namespace {

constexpr std::string_view nowcast_words = "nowcast, ";
constexpr std::string_view score_words = "error of the nowcast: ";

}  // namespace

std::array<std::string, 2> nowcast_notes(double minutes, const std::string& score) {
    return {fmt::format("{}{:.3g} minutes, by advection", nowcast_words, minutes),
            fmt::format("{}{}", score_words, score)};
}

NowcastNote nowcast_in_notes(std::span<const std::string> notes) {
    NowcastNote found;
    for (const std::string& note : notes) {
        if (note.starts_with(nowcast_words)) found.nowcast = note;
        if (note.starts_with(score_words)) found.score = note.substr(score_words.size());
    }
    if (found.nowcast.empty()) found.score.clear();
    return found;
}

}  // namespace stormcellar::retrieve
