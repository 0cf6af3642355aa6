// retrieve/rain/rain_note.h -- the note by which a grid says that it is a rain total.
//
// The note tells the time that the total covers, the minutes of this time for which there are no
// volumes, and the columns that were not seen for a part of the time.
//
// Threads   Pure functions.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "stormcellar/base/utc_time.h"

namespace stormcellar::retrieve {

struct RainNote {
    UtcTime from;
    double minutes = 0;
    double gap_minutes = 0;  // of these, without volumes
    int volumes = 0;
    std::ptrdiff_t columns_partly_unseen = 0;
};
[[nodiscard]] std::string rain_note(const RainNote& note);

// The facts for the labels of a picture.
struct RainFacts {
    UtcTime from;
    std::string span;  // "180 minutes, 12 of them without volumes"
};
// Returns none if no note is of a rain total.
[[nodiscard]] std::optional<RainFacts> rain_in_notes(std::span<const std::string> notes);

}  // namespace stormcellar::retrieve
