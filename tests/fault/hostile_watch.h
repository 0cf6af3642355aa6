// tests/fault/hostile_watch.h -- what a daemon under attack holds, and what it leaves behind.
//
// Looks from outside: at /proc, at the files of its state and cache, and asks readers of the
// product alone. What vanishes while it is looked at counts as not there.
// Thread contract: functions without state.
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
    std::string database, state, reason;  // the database without its ending
};
// Of every database that can be read, by the file's path.
[[nodiscard]] std::multimap<std::filesystem::path, CatalogRow> catalog_rows(
    const std::filesystem::path& catalog);
// The names of the databases, without the ending: "KTLX", "_unknown".
[[nodiscard]] std::set<std::string> databases_in(const std::filesystem::path& catalog);
// The names of the domains that have a directory in the cache.
[[nodiscard]] std::set<std::string> domains_in(const std::filesystem::path& cache);
// Of these names those that are no station of the table; "_unknown" is left out.
[[nodiscard]] std::set<std::string> invented_among(const std::set<std::string>& names);

[[nodiscard]] std::size_t open_descriptors(pid_t process);
// Of the processors, in user and system mode.
[[nodiscard]] double cpu_seconds(pid_t process);
// On disk, of the files without a name that it holds open.
[[nodiscard]] std::uint64_t unnamed_bytes(pid_t process);
[[nodiscard]] std::uint64_t disk_bytes_below(const std::filesystem::path& directory);

// The station's grid of this time stands in the cache and is that of a whole volume.
[[nodiscard]] bool has_whole_grid(const std::filesystem::path& cache, const std::string& station,
                                  UtcTime time);

// Asks again every 20 ms; false when it does not come true within `seconds`.
bool comes_true(double seconds, const std::function<bool()>& wanted);

// Waits until nothing is pending and it has taken hardly any time of the processors for a second:
// what it is told of itself may be a second old. False where that does not come within `seconds`.
bool comes_to_rest(const daemon::RunningDaemon& daemon, double seconds);

// Starts it with a service manager's socket, and gives the seconds until it said READY=1; throws
// where it ends before, or has not said so after 30 s.
double start_until_ready(daemon::RunningDaemon& daemon, const std::string& config);

}  // namespace stormcellar::fault
