// daemon/config/config.h -- the contents of stormcellard.toml.
//
// The shipped file (daemon/stormcellard.toml) explains every key and holds every default; a test
// compares the two.
//
// Units     Distances are kilometers in the file and meters here.
// Threads   Plain data.
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

// The limit of the rows of all databases.
inline constexpr std::uint64_t default_catalog_bytes = 16'000'000'000;

// The file system may be at most 95 % full; there is no limit of bytes or age.
[[nodiscard]] cache::Budgets default_budgets();

// Where the status is served (status_server.h).
struct StatusConfig {
    std::filesystem::path socket;  // absolute; empty: default_socket()
    int http_port = 0;             // 0: none
    bool operator==(const StatusConfig&) const = default;
};

// Returns status.sock in the first of systemd's $RUNTIME_DIRECTORY (null: none), else in the state
// directory.
[[nodiscard]] std::filesystem::path default_socket(const std::filesystem::path& state,
                                                   const char* runtime_directory);

struct Config {
    // Absolute, with symbolic links resolved; none lies within another.
    std::filesystem::path drop;
    std::filesystem::path state = "/var/lib/stormcellar";
    std::filesystem::path cache = "/var/cache/stormcellar";

    pipeline::IngestOptions ingest;
    StationRule stations;  // the stations from which data are accepted
    std::vector<AddedStation> added_stations;
    bool living = true;                  // volumes are gridded while they grow
    std::optional<bunzip::Path> bunzip;  // none: the fastest that the machine supports
    int workers = 0;                     // 0: one for each processor; see worker_count()
    std::chrono::milliseconds quiet{30'000};
    std::chrono::milliseconds reread{500};
    std::chrono::milliseconds rescan{60'000};
    std::chrono::milliseconds poll{5'000};  // the same if changes come without events
    std::size_t queue_limit = 65'536;       // files
    cache::Budgets budgets = default_budgets();
    cache::Packing packing = cache::Packing::none;
    // how new the missing grids are that are made again
    std::chrono::milliseconds refill{std::chrono::hours{6}};
    std::chrono::milliseconds gone_kept{0};  // how long rows of missing files are kept; 0: forever
    std::optional<std::uint64_t> catalog_bytes = default_catalog_bytes;  // none: no limit
    std::string log_level = "info";
    StatusConfig status;
    std::vector<LoopConfig> loops;

    [[nodiscard]] int worker_count() const;
};

// Returns true if two configurations make the same grids in the same way.
[[nodiscard]] bool same_grids(const pipeline::IngestOptions& a, const pipeline::IngestOptions& b);

// Relative paths start at the directory of the file. Nothing is created, and directories need not
// exist; scenes of loops must exist only if that is requested. Errors: bad_argument, "FILE:LINE:
// [section] key: why", for unknown keys, wrong types, values out of range and paths within one
// another.
[[nodiscard]] Result<Config> load_config(const std::filesystem::path& file,
                                         SceneFiles scenes = SceneFiles::as_named);

}  // namespace stormcellar::daemon
