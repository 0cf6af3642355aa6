// fetch/feed/feed_status.h -- the contents of status.json: the state of the feed, for people and
// monitoring.
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
    std::string error;                  // why the last request failed; empty: it succeeded
    std::optional<UtcTime> answered;    // when the bucket last answered for this station
    std::optional<UtcTime> next_try;    // after a failure
    bool is_searching = true;           // the newest volume is being searched
    bool is_silent = false;             // no new chunk for 10 minutes
    std::optional<VolumeId> volume;     // the volume being followed
    int chunk = 0;                      // the highest chunk that was written or given up
    std::optional<UtcTime> written_at;  // when a chunk was last written
    std::uint64_t written = 0;          // chunks written since the start
    std::uint64_t present = 0;          // chunks found in the directory since the start
    std::uint64_t refused = 0;          // chunks given up since the start
    std::uint64_t missing = 0;          // chunks that never came, since the start
    std::uint64_t listings = 0;         // requests for listings since the start
    std::uint64_t failures = 0;         // failed requests since the start
};

struct FeedStatus {
    std::string bucket, drop;
    std::uint64_t bytes = 0;    // in the drop directory
    std::uint64_t volumes = 0;  // in the drop directory
    std::uint64_t removed = 0;  // volumes removed since the start
    std::vector<StationStatus> stations;
};

// Returns one JSON object, ended by a line feed.
[[nodiscard]] std::string status_text(const FeedStatus& status, UtcTime now);

}  // namespace stormcellar::feed
