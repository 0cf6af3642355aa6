// daemon/config/config.h -- the contents of stormcellard.toml.
//
// The shipped file (daemon/stormcellard.toml) explains every key and holds every default; a test
// compares it with this header.
//
// Units     Distances are kilometers in the file and meters here.
// Threads   Plain data.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bunzip/paths.h"
#include "daemon/config/loop_config.h"
#include "pipeline/options/domain.h"
#include "stormcellar/base/result.h"
#include "stormcellar/base/station_rule.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/cache/budget.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/level2/volume.h"
#include "stormcellar/retrieve/dealias.h"
#include "web/config/web_config.h"

namespace stormcellar::daemon {

// The default limit of the size of all rows in all databases.
inline constexpr std::uint64_t default_catalog_bytes = 16'000'000'000;

// Returns the default limits. The file system may be at most 95 % full; bytes and age have no
// limit.
[[nodiscard]] cache::Budgets default_budgets();

// The addresses at which the status is served (status_server.h).
struct StatusConfig {
    std::filesystem::path socket;  // absolute; empty: default_socket()
    int http_port = 0;             // 0: none
    bool operator==(const StatusConfig&) const = default;
};

// Returns the path of status.sock. It is in the first directory of `runtime_directory` (the value
// of systemd's $RUNTIME_DIRECTORY; null: not set), or else in the state directory.
[[nodiscard]] std::filesystem::path default_socket(const std::filesystem::path& state,
                                                   const char* runtime_directory);

// The three directories. They are absolute, with symbolic links resolved, and none is within
// another.
struct PathsConfig {
    std::filesystem::path drop;
    std::filesystem::path state = "/var/lib/stormcellar";
    std::filesystem::path cache = "/var/cache/stormcellar";
    bool operator==(const PathsConfig&) const = default;
};

// The grids to make, and the number of threads. The defaults are the same as in
// pipeline::IngestOptions.
struct GridConfig {
    std::vector<level2::Moment> moments = {level2::Moment::ref};
    retrieve::Dealiasing dealiasing = retrieve::Dealiasing::automatic;  // for derived moments
    double quality = 0;  // echo is gridded if it is weather with at least this probability
    double spacing_m = 1000;
    int nx = 460, ny = 460;
    std::vector<double> levels_m;           // empty: the default 32
    std::vector<pipeline::Domain> domains;  // mosaics to keep in addition to each site's own grid
    int threads = 1;                        // for decoding and for gridding
    bool operator==(const GridConfig&) const = default;
};

struct IngestConfig {
    StationRule stations;  // the stations from which data are accepted
    std::vector<AddedStation> added_stations;
    bool living = true;  // volumes are gridded while they grow
    std::chrono::seconds chunk_timeout{600}, chunk_grace{30};  // see pipeline::LivingGrids
    std::optional<bunzip::Path> bunzip;  // none: the fastest that the machine supports
    bool operator==(const IngestConfig&) const = default;
};

// The directories into which other machines' partials of mosaics are copied, one for each machine.
struct PartialsConfig {
    std::vector<std::filesystem::path> directories;  // absolute, with symbolic links resolved
    std::chrono::seconds late_after{600};
    // The stations that each machine may bring, by the name of the machine. A machine without a
    // list may bring all stations that no machine's list has.
    std::map<std::string, std::vector<std::string>> stations;
    [[nodiscard]] bool may_bring(const std::string& machine, const std::string& station) const;
    bool operator==(const PartialsConfig&) const = default;
};

// The limits of the catalog and the cache.
struct StorageConfig {
    cache::Packing packing = cache::Packing::none;
    // Missing grids that are newer than this are made again; 0: none.
    std::chrono::milliseconds refill{std::chrono::hours{6}};
    std::optional<std::uint64_t> catalog_bytes = default_catalog_bytes;  // none: no limit
    bool operator==(const StorageConfig&) const = default;
};

// The keys that take effect only when the service starts.
struct FixedConfig {
    PathsConfig paths;
    GridConfig grid;
    std::size_t queue_limit = 65'536;  // files
    IngestConfig ingest;
    StorageConfig storage;
    StatusConfig status;
    PartialsConfig partials;
    bool operator==(const FixedConfig&) const = default;
};

// The keys that take effect when the configuration is read again.
struct ReloadableConfig {
    int workers = 0;  // 0: one for each processor; see worker_count()
    std::chrono::milliseconds quiet{30'000};
    std::chrono::milliseconds reread{500};
    std::chrono::milliseconds rescan{60'000};
    // Time between scans while some directories change without events.
    std::chrono::milliseconds poll{5'000};
    cache::Budgets budgets = default_budgets();
    // Rows of missing files are kept for this time; 0: for ever.
    std::chrono::milliseconds gone_rows_kept_for{0};
    std::string log_level = "info";
    std::vector<LoopConfig> loops;
    web::WebConfig web;  // for stormcellar-web; the daemon only checks it

    [[nodiscard]] int worker_count() const;
    bool operator==(const ReloadableConfig&) const = default;
};

// The whole configuration. Every key is in one of its two parts. A reload replaces all of
// `reloadable`, and reports what has changed in `fixed`.
struct Config {
    FixedConfig fixed;
    ReloadableConfig reloadable;
    bool operator==(const Config&) const = default;
};

// Returns a sentence for each part of `fresh` that differs from `running`. The sentence names the
// keys, and says that they need a restart. Returns no sentences if, and only if, `fresh` equals
// `running`.
[[nodiscard]] std::vector<std::string> needs_restart(const FixedConfig& fresh,
                                                     const FixedConfig& running);

// Loads the configuration. Relative paths start at the directory of the file. Creates nothing.
// Directories need not exist; the scenes of loops must exist if `scenes` is must_exist. Errors:
// bad_argument, "FILE:LINE: [section] key: why", for unknown keys, wrong types, values out of
// range, and directories within one another.
[[nodiscard]] Result<Config> load_config(const std::filesystem::path& file,
                                         SceneFiles scenes = SceneFiles::as_named);

}  // namespace stormcellar::daemon
