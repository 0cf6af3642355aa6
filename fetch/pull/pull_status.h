// fetch/pull/pull_status.h -- how the pulling goes, for people and for monitoring: status.json.
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
    std::string error;                // why the last turn failed; empty: it did not
    std::optional<UtcTime> answered;  // when the machine last answered
    std::optional<UtcTime> next_try;  // of a machine that failed
    std::optional<UtcTime> newest;    // grid
    std::size_t grids = 0;
    std::uint64_t bytes = 0;     // on disk
    std::uint64_t pulled = 0;    // since the start: grids that were kept,
    std::uint64_t refused = 0;   // those that failed a check or came cut,
    std::uint64_t removed = 0;   // those that the limits removed,
    std::uint64_t failures = 0;  // and turns that failed
};

// One JSON object, with a line feed behind it.
[[nodiscard]] std::string status_text(const std::vector<SourceStatus>& sources, UtcTime now);

}  // namespace stormcellar::pull
