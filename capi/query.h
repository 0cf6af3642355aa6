// capi/query.h -- reads the times of a query.
//
// Threads   Pure functions.
#pragma once

#include <chrono>
#include <cstdint>
#include <limits>
#include <optional>

#include "stormcellar.h"
#include "stormcellar/base/utc_time.h"

namespace stormcellar::capi {

inline constexpr std::int64_t unknown_time = std::numeric_limits<std::int64_t>::min();

[[nodiscard]] inline std::int64_t milliseconds_of(UtcTime time) {
    return time.time_since_epoch().count();
}
[[nodiscard]] inline std::int64_t milliseconds_of(std::optional<UtcTime> time) {
    return time ? milliseconds_of(*time) : unknown_time;
}

// Times from the first to the last, both included; none: no limit.
struct TimeRange {
    std::optional<UtcTime> from, to;
};
[[nodiscard]] inline TimeRange range_of(const stormcellar_query& query) {
    const auto time = [](std::int64_t time_ms) {
        return time_ms == 0 ? std::nullopt
                            : std::optional(UtcTime(std::chrono::milliseconds(time_ms)));
    };
    return {time(query.from_ms), time(query.to_ms)};
}

}  // namespace stormcellar::capi
