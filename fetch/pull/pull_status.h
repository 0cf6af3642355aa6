// fetch/pull/pull_status.h -- the contents of status.json: the state of each source machine, for
// people and for monitoring.
//
// Threads   Plain data and a pure function.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "stormcellar/base/utc_time.h"

namespace stormcellar::pull {

struct SourceStatus {
    std::string name, url;
    std::string error;                // why the last turn failed; empty: it succeeded
    std::optional<UtcTime> answered;  // when the machine last answered
    std::optional<UtcTime> next_try;  // set after a failed turn
    std::optional<UtcTime> newest;    // time of the newest grid
    std::size_t grids = 0;
    std::uint64_t bytes = 0;     // on disk
    std::uint64_t pulled = 0;    // grids kept since the start
    std::uint64_t refused = 0;   // grids that failed a check or were cut off, since the start
    std::uint64_t removed = 0;   // grids that the limits removed since the start
    std::uint64_t failures = 0;  // turns that failed since the start
};

// Returns one JSON object, ended by a line feed.
[[nodiscard]] std::string status_text(const std::vector<SourceStatus>& sources, UtcTime now);

}  // namespace stormcellar::pull
