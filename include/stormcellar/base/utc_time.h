// stormcellar/base/utc_time.h -- instants, always UTC, to the millisecond (the resolution of Level
// II data).
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

#include "stormcellar/base/result.h"

namespace stormcellar {

using UtcTime = std::chrono::sys_time<std::chrono::milliseconds>;

[[nodiscard]] UtcTime now_utc();

// What claims to be of later than this is kept, and is nobody's newest: the clock of a radar, or of
// this machine, is wrong.
inline constexpr std::chrono::minutes tolerated_future{10};
[[nodiscard]] inline bool is_believed(UtcTime time, UtcTime now) {
    return time <= now + tolerated_future;
}

// Negative when `to` is the earlier one.
[[nodiscard]] inline double seconds_between(UtcTime from, UtcTime to) {
    return std::chrono::duration<double>(to - from).count();
}

// The time of a NEXRAD "modified Julian date" (day 1 is 1970-01-01) and milliseconds after
// midnight, as in ICD 2620010 section 3.2. Days and milliseconds beyond their range are carried.
[[nodiscard]] UtcTime time_from_nexrad(std::uint32_t day, std::uint32_t milliseconds);

// The inverse: day number and milliseconds. Times before 1970 give day 0 and 0 ms.
struct NexradTime {
    std::uint32_t day = 0;
    std::uint32_t milliseconds = 0;
};
[[nodiscard]] NexradTime nexrad_from_time(UtcTime time);

// "2022-03-17T00:08:42.596Z"; the fraction is left out when it is zero.
[[nodiscard]] std::string format_utc(UtcTime time);

// "20220317_000842": as in the names of Level II files. Milliseconds are dropped.
[[nodiscard]] std::string format_compact(UtcTime time);

// Accepts ISO 8601 in UTC ("2022-03-17", "2022-03-17T00:08", "2022-03-17T00:08:42.596Z", a space
// for the T), the compact form "20220317_000842", "now", and a time relative to `now`: a minus
// sign, a number and s, m, h or d ("-1h", "-90m"). Anything else is bad_argument.
[[nodiscard]] Result<UtcTime> parse_utc(std::string_view text, UtcTime now);

// Parses the compact form only; used for file names.
[[nodiscard]] Result<UtcTime> parse_compact(std::string_view text);

}  // namespace stormcellar
