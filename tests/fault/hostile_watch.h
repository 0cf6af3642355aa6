// tests/fault/hostile_watch.h -- observes the resources and the files of a daemon under attack.
//
// The functions observe from outside the daemon. They read /proc and the files of state and cache,
// and use only readers of the product. Files that vanish meanwhile do not count.
//
// Threads   Functions without state.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <string_view>

#include <sys/types.h>

#include "stormcellar/base/utc_time.h"
#include "tests/daemon/running_daemon.h"

namespace stormcellar::fault {

struct CatalogRow {
    std::string database, state, reason;  // database: its file name without the ending
};
// Returns the rows of every database that can be read, by the path of the file.
[[nodiscard]] std::multimap<std::filesystem::path, CatalogRow> catalog_rows(
    const std::filesystem::path& catalog);
// Returns the names of the databases without the ending: "KTLX", "_unknown".
[[nodiscard]] std::set<std::string> databases_in(const std::filesystem::path& catalog);
// Returns the names of the domains that have a directory in the cache.
[[nodiscard]] std::set<std::string> domains_in(const std::filesystem::path& cache);
// Returns the names that are not in the station table, without "_unknown".
[[nodiscard]] std::set<std::string> invented_among(const std::set<std::string>& names);

[[nodiscard]] std::size_t open_descriptors(pid_t process);
// Returns the processor time in user and system mode.
[[nodiscard]] double cpu_seconds(pid_t process);
// Returns the size on disk of the unnamed files that the process holds open.
[[nodiscard]] std::uint64_t unnamed_bytes(pid_t process);
[[nodiscard]] std::uint64_t disk_bytes_below(const std::filesystem::path& directory);

// Returns true if the cache has the grid of this station and time, made from a whole volume.
[[nodiscard]] bool has_whole_grid(const std::filesystem::path& cache, const std::string& station,
                                  UtcTime time);

// Checks the condition every 20 ms. Returns false if it does not become true within `seconds`.
bool comes_true(double seconds, const std::function<bool()>& wanted);

// Waits until nothing is pending and the daemon has used hardly any processor time for a second,
// because its status may be a second old. Returns false if that takes longer than `seconds`.
bool comes_to_rest(const daemon::RunningDaemon& daemon, double seconds);

// Starts the daemon with the socket of a service manager, and returns the seconds until READY=1.
// Throws if the daemon ends first or is not ready after 30 s.
double start_until_ready(daemon::RunningDaemon& daemon, const std::string& config);

}  // namespace stormcellar::fault
