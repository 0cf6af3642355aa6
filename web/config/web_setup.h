// web/config/web_setup.h -- what the data server reads from stormcellard.toml: its own tables, the
// directories, the added stations, and the log level.
//
// Threads   Plain data and a pure function.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/base/station_table.h"
#include "web/config/served_loops.h"
#include "web/config/web_config.h"

namespace stormcellar::web {

struct WebSetup {
    std::filesystem::path drop;  // empty: unknown
    std::filesystem::path state = "/var/lib/stormcellar";
    std::filesystem::path catalog = "/var/lib/stormcellar/catalog";  // empty: none
    std::filesystem::path cache = "/var/cache/stormcellar";          // empty: none
    // Directory for the numbers of times (web/data/zarr/time_numbers.h). If empty, the numbers are
    // only in memory. stormcellard.toml has no key for it; the program stormcellar-web sets it to
    // $STATE_DIRECTORY/times.
    std::filesystem::path numbers;
    std::vector<AddedStation> added_stations;
    std::vector<ServedLoop> loops;
    std::string log_level = "info";  // debug, info, warning or error
    WebConfig web;
    bool operator==(const WebSetup&) const = default;
};

// Reads the setup. Relative paths start at the directory of the file. Ignores tables that only
// stormcellard uses. Errors: those of reading the file; bad_argument, "FILE:LINE: [section] key:
// why".
[[nodiscard]] Result<WebSetup> load_web_setup(const std::filesystem::path& file);

// Returns a sentence for each difference between `fresh` and `running` that a reload cannot apply.
// [paths] and [[station]] take effect only at a start; [web], [log] and [[loop]] take effect at
// once.
[[nodiscard]] std::vector<std::string> needs_restart(const WebSetup& fresh,
                                                     const WebSetup& running);

}  // namespace stormcellar::web
