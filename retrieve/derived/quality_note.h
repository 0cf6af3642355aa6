// retrieve/derived/quality_note.h -- the numbers in notes about echo that is probably not weather.
//
// Threads   Pure functions.
#pragma once

#include <optional>
#include <span>
#include <string>

namespace stormcellar::retrieve {

struct QualityNote {
    double least = 0;             // echo with a lesser probability of weather is left out
    std::optional<double> share;  // of the echo; none if unknown, as for a mosaic
};

// Reads what quality_in_notes() returns. None if no note says that echo is left out.
[[nodiscard]] std::optional<QualityNote> quality_note_in(std::span<const std::string> notes);

// Returns true if the notes say that echo with a lesser probability of weather was left out, and no
// other echo. For 0, returns true if no note says that echo is left out.
[[nodiscard]] bool is_of_quality(std::span<const std::string> notes, double least);

}  // namespace stormcellar::retrieve
