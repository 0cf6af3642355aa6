// web/doors/thredds/w3c_times.h -- dates and durations as THREDDS clients write them.
//
// Dates are those of ISO 8601 that W3C's note on date and time formats names, in any precision from
// the year on, with "Z", an offset or nothing (UTC) behind the time, and "present". Durations are
// those of W3C XML Schema ("P1DT12H") or a number and a unit, as in "14 days".
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

// Years from 1900 to 2199 are taken. A date without a time is its first instant.
[[nodiscard]] Result<UtcTime> parse_w3c_time(std::string_view text, UtcTime now);

// Months are kept apart, because their length depends on where they are counted from.
struct W3cDuration {
    int months = 0;
    std::chrono::milliseconds rest{0};
    bool operator==(const W3cDuration&) const = default;
};
// Durations up to 1000 years are taken, none that is negative.
[[nodiscard]] Result<W3cDuration> parse_w3c_duration(std::string_view text);

// A month before March 31 is the last of February.
[[nodiscard]] UtcTime later_by(UtcTime time, const W3cDuration& duration);
[[nodiscard]] UtcTime earlier_by(UtcTime time, const W3cDuration& duration);

}  // namespace stormcellar::web
