// fetch/feed/feed_status.h -- how the feed goes, for people and for monitoring: status.json.
//
// Threads   Plain data and a pure function.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fetch/feed/chunk_key.h"

namespace stormcellar::feed {

struct StationStatus {
    std::string station;
    std::string error;                  // why the last request failed; empty: it did not
    std::optional<UtcTime> answered;    // when the bucket last answered for this station
    std::optional<UtcTime> next_try;    // after a failure
    bool is_searching = true;           // for the newest volume
    bool is_silent = false;             // nothing new for 10 minutes
    std::optional<VolumeId> volume;     // the one that is followed
    int chunk = 0;                      // its highest chunk that was dealt with
    std::optional<UtcTime> written_at;  // when a chunk was last written
    std::uint64_t written = 0;          // since the start: chunks that were written,
    std::uint64_t present = 0;          // those that were there already,
    std::uint64_t refused = 0;          // those that were given up,
    std::uint64_t missing = 0;          // those that never came,
    std::uint64_t listings = 0;         // requests for lists,
    std::uint64_t failures = 0;         // and requests that failed
};

struct FeedStatus {
    std::string bucket, drop;
    std::uint64_t bytes = 0;    // in the drop directory
    std::uint64_t volumes = 0;  // the same
    std::uint64_t removed = 0;  // volumes, since the start
    std::vector<StationStatus> stations;
};

// One JSON object, with a line feed behind it.
[[nodiscard]] std::string status_text(const FeedStatus& status, UtcTime now);

}  // namespace stormcellar::feed
