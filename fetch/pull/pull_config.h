// fetch/pull/pull_config.h -- reads the tables [pull] and [[pull.from]] of stormcellard.toml.
//
// Threads   Plain data and a pure function.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "stormcellar/base/result.h"

namespace stormcellar::pull {

// A machine whose stormcellar-web offers grids to pull.
struct PullSource {
    std::string name;  // also the name of its directory
    std::string url;   // "http://HOST:PORT", perhaps with a path, without a '/' at the end
    std::vector<std::string> domains = {};   // pull partials only of these domains; empty: all
    std::vector<std::string> stations = {};  // pull partials only of these stations; empty: all
    bool operator==(const PullSource&) const = default;
};

struct PullConfig {
    std::filesystem::path directory = "/var/lib/stormcellar-pull";  // parent of each source's
                                                                    // directory
    std::vector<PullSource> sources;
    std::chrono::milliseconds every{5000};
    std::chrono::seconds age{std::chrono::hours{3}};  // greatest age of grids that are pulled and
                                                      // kept
    std::uint64_t bytes_a_source = 20'000'000'000;    // on disk; the oldest grids are removed first
    std::chrono::seconds stall{20};                   // a transfer without a byte for this long
                                                      // fails
    std::string log_level = "info";                   // debug, info, warning or error
    bool operator==(const PullConfig&) const = default;
};

// Loads the configuration. Relative paths start at the directory of the file. Ignores the tables of
// other programs. Errors: those of reading the file; bad_argument, "FILE:LINE: [section] key: why".
[[nodiscard]] Result<PullConfig> load_pull_config(const std::filesystem::path& file);

}  // namespace stormcellar::pull
