// stormcellar/base/utc_time.h -- instants in UTC, to the millisecond (the resolution of Level II
// data).
//
// Units     Milliseconds inside, seconds in seconds_between().
// Threads   Pure functions; now_utc() reads the system's clock.
// Errors    The parse functions return bad_argument, with the text in the message.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

#include "stormcellar/base/result.h"

namespace stormcellar {

using UtcTime = std::chrono::sys_time<std::chrono::milliseconds>;

[[nodiscard]] UtcTime now_utc();

// Data with a time further in the future are kept, but do not count as the newest, because the
// clock of the radar, or of this machine, must be wrong.
inline constexpr std::chrono::minutes tolerated_future{10};
[[nodiscard]] inline bool is_believed(UtcTime time, UtcTime now) {
    return time <= now + tolerated_future;
}

// Returns the seconds between two instants, negative if `to` is the earlier one.
[[nodiscard]] inline double seconds_between(UtcTime from, UtcTime to) {
    return std::chrono::duration<double>(to - from).count();
}

// Returns the instant of a NEXRAD "modified Julian date" (day 1 is 1970-01-01) and milliseconds
// after midnight, as in ICD 2620010 section 3.2. If there are more milliseconds than a day has, the
// instant is on a later day.
[[nodiscard]] UtcTime time_from_nexrad(std::uint32_t day, std::uint32_t milliseconds);

// A day number and milliseconds, as above.
struct NexradTime {
    std::uint32_t day = 0;
    std::uint32_t milliseconds = 0;
};
// Returns the day and milliseconds of an instant, so that time_from_nexrad() returns the same
// instant. For an instant before 1970, returns day 0 and 0 ms.
[[nodiscard]] NexradTime nexrad_from_time(UtcTime time);

// Writes "2022-03-17T00:08:42.596Z"; leaves out the fraction if it is zero.
[[nodiscard]] std::string format_utc(UtcTime time);

// Writes "20220317_000842", as in the names of Level II files. Drops the milliseconds.
[[nodiscard]] std::string format_compact(UtcTime time);

// Parses ISO 8601 in UTC ("2022-03-17", "2022-03-17T00:08", "2022-03-17T00:08:42.596Z", or a space
// for the T), the compact form "20220317_000842", "now", or a time relative to `now`: a minus sign,
// a number and s, m, h or d ("-1h", "-90m"). Returns bad_argument for anything else.
[[nodiscard]] Result<UtcTime> parse_utc(std::string_view text, UtcTime now);

// Parses the compact form only, for names of files.
[[nodiscard]] Result<UtcTime> parse_compact(std::string_view text);

}  // namespace stormcellar
