// daemon/config/config.h -- what stormcellard.toml says.
//
// The shipped file (daemon/stormcellard.toml) explains every key and holds every default; a test
// compares the two. Distances are kilometres in the file and metres here.
// Thread contract: plain data.
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "bunzip/paths.h"
#include "daemon/config/loop_config.h"
#include "pipeline/ingest/ingest.h"
#include "stormcellar/base/result.h"
#include "stormcellar/base/station_rule.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/cache/budget.h"

namespace stormcellar::daemon {

// What the rows of all databases may take.
inline constexpr std::uint64_t default_catalog_bytes = 16'000'000'000;

// The file system at most 95 % full; no limit of bytes or age.
[[nodiscard]] cache::Budgets default_budgets();

// Where the status is asked for (status_server.h).
struct StatusConfig {
    std::filesystem::path socket;  // absolute; empty: default_socket()
    int http_port = 0;             // 0: none
    bool operator==(const StatusConfig&) const = default;
};

// status.sock in the first of systemd's $RUNTIME_DIRECTORY (none: null), else in the state
// directory.
[[nodiscard]] std::filesystem::path default_socket(const std::filesystem::path& state,
                                                   const char* runtime_directory);

struct Config {
    // Absolute, symbolic links resolved; none lies within another.
    std::filesystem::path drop;
    std::filesystem::path state = "/var/lib/stormcellar";
    std::filesystem::path cache = "/var/cache/stormcellar";

    pipeline::IngestOptions ingest;
    StationRule stations;  // of which data are taken in
    std::vector<AddedStation> added_stations;
    bool living = true;                  // volumes are gridded while they grow
    std::optional<bunzip::Path> bunzip;  // none: the fastest that the machine has
    int workers = 0;                     // 0: one a processor; see worker_count()
    std::chrono::milliseconds quiet{30'000};
    std::chrono::milliseconds reread{500};
    std::chrono::milliseconds rescan{60'000};
    std::chrono::milliseconds poll{5'000};  // the same where changes come without events
    std::size_t queue_limit = 65'536;       // files
    cache::Budgets budgets = default_budgets();
    cache::Packing packing = cache::Packing::none;
    std::chrono::milliseconds refill{std::chrono::hours{6}};  // of missing grids, the newest
    std::chrono::milliseconds gone_kept{0};  // rows of files that are gone; 0: for ever
    std::optional<std::uint64_t> catalog_bytes = default_catalog_bytes;  // none: no limit
    std::string log_level = "info";
    StatusConfig status;
    std::vector<LoopConfig> loops;

    [[nodiscard]] int worker_count() const;
};

// True when two configurations make the same grids in the same way.
[[nodiscard]] bool same_grids(const pipeline::IngestOptions& a, const pipeline::IngestOptions& b);

// Relative paths are taken from the directory of the file. Unknown keys, wrong types, values out of
// range and paths within one another are bad_argument: "FILE:LINE: [section] key: why".
// Nothing is created and the directories need not exist, nor, unless asked for, the loops' scenes.
[[nodiscard]] Result<Config> load_config(const std::filesystem::path& file,
                                         SceneFiles scenes = SceneFiles::as_named);

}  // namespace stormcellar::daemon
