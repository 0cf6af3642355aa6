// fetch/pull/pull_config.h -- what stormcellar-pull reads of stormcellard.toml: [pull] and
// [[pull.from]].
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

// A machine whose stormcellar-web is asked.
struct PullSource {
    std::string name;  // of its directory
    std::string url;   // "http://HOST:PORT" and perhaps a path, without a last '/'
    std::vector<std::string> domains = {};   // whose partials are pulled; empty: those of all
    std::vector<std::string> stations = {};  // the same
    bool operator==(const PullSource&) const = default;
};

struct PullConfig {
    std::filesystem::path directory = "/var/lib/stormcellar-pull";  // each source has one below it
    std::vector<PullSource> sources;
    std::chrono::milliseconds every{5000};
    std::chrono::seconds age{std::chrono::hours{3}};  // of the grids that are pulled and kept
    std::uint64_t bytes_a_source = 20'000'000'000;    // on disk; the oldest grids give way
    std::chrono::seconds stall{20};                   // a transfer without a byte for so long fails
    std::string log_level = "info";                   // debug, info, warning or error
    bool operator==(const PullConfig&) const = default;
};

// Relative paths start at the directory of the file. The tables of other programs are not looked
// at. Errors: those of reading the file; bad_argument, "FILE:LINE: [section] key: why".
[[nodiscard]] Result<PullConfig> load_pull_config(const std::filesystem::path& file);

}  // namespace stormcellar::pull
