// fetch/feed/feed_config.h -- reads the table [feed] of stormcellard.toml.
//
// Threads   Plain data and a pure function.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "stormcellar/base/result.h"

namespace stormcellar::feed {

inline constexpr const char* default_bucket =
    "https://unidata-nexrad-level2-chunks.s3.amazonaws.com";

struct FeedConfig {
    std::vector<std::string> stations;
    std::string bucket = default_bucket;  // without a '/' at the end
    std::filesystem::path drop = "/var/lib/stormcellar-feed/drop";
    std::filesystem::path state = "/var/lib/stormcellar-feed";  // the directory of status.json
    std::chrono::milliseconds every{4000};
    // Volumes in the drop directory are removed at this age.
    std::chrono::seconds keep{std::chrono::hours{8}};
    std::uint64_t bytes = 50'000'000'000;  // for all volumes; the oldest are removed
                                           // first
    std::chrono::seconds stall{20};        // a transfer fails if no byte comes for this long
    std::string proxy;                     // empty: none
    std::string ca_file;                   // empty: the certificates of the system
    std::string log_level = "info";        // debug, info, warning or error
    // These three are not in the file: how many listings of a station may be without news within a
    // minute, the time after which a station counts as silent, and the time between checks of the
    // ages of volumes.
    std::size_t most_in_vain = 20;
    std::chrono::milliseconds silent_after = std::chrono::minutes{10};
    std::chrono::seconds between_prunes{20};
    bool operator==(const FeedConfig&) const = default;
};

// Loads the configuration. Relative paths start at the directory of the file. Ignores the tables of
// other programs. But if stations are named, reads [paths] drop: the feed's `drop` must be that
// directory or below it. Errors: those of reading the file; bad_argument, "FILE:LINE: [section]
// key: why".
[[nodiscard]] Result<FeedConfig> load_feed_config(const std::filesystem::path& file);

}  // namespace stormcellar::feed
