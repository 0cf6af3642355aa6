// web/doors/thredds/w3c_times.h -- reads dates and durations as THREDDS clients write them.
//
// Dates have the forms of ISO 8601 in W3C's note on date and time formats. They have any precision
// from the year on, and end with "Z", an offset or nothing (UTC). "present" is a date, too. A
// duration has the form of W3C XML Schema ("P1DT12H"), or is a number and a unit, as in "14 days".
//
// Units     Milliseconds.
// Threads   Pure functions.
// Errors    bad_argument, with a sentence that names the text.
#pragma once

#include <chrono>
#include <string>
#include <string_view>

#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"

namespace stormcellar::web {

// Reads a date in the years 1900 to 2199. A date without a time means the first instant of that
// day, month or year.
[[nodiscard]] Result<UtcTime> parse_w3c_time(std::string_view text, UtcTime now);

// A duration. Months are separate, because the length of a month depends on where it starts.
struct W3cDuration {
    int months = 0;
    std::chrono::milliseconds rest{0};
    bool operator==(const W3cDuration&) const = default;
};
// Reads a duration of up to 1000 years. Refuses negative durations.
[[nodiscard]] Result<W3cDuration> parse_w3c_duration(std::string_view text);

// Returns the time that is later by the duration. For example, a month before March 31 is the last
// day of February.
[[nodiscard]] UtcTime later_by(UtcTime time, const W3cDuration& duration);
[[nodiscard]] UtcTime earlier_by(UtcTime time, const W3cDuration& duration);

}  // namespace stormcellar::web
