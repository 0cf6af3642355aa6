// cache/directories.h -- reads the directories of a cache. Used only inside the cache room.
//
// Symbolic links are not followed. Files and directories whose names do not belong in a cache are
// left out, and so are files that vanish while their directory is read. A missing directory counts
// as empty.
//
// Threads   The functions read directories and have no state.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "stormcellar/base/file_system.h"
#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/cache/grid_name.h"

namespace stormcellar::cache {

// Makes the error of a failed operation on a directory, with its path.
[[nodiscard]] tl::unexpected<Error> directory_failure(const std::filesystem::path& path,
                                                      const std::error_code& error);

// Returns the domains, sorted.
[[nodiscard]] Result<std::vector<std::string>> domains_in(const std::filesystem::path& cache);
[[nodiscard]] Result<std::vector<level2::Moment>> moments_in(const std::filesystem::path& domain);
[[nodiscard]] Result<std::vector<std::string>> days_in(const std::filesystem::path& moment);

// A directory of the cache: one day of one moment of one domain.
struct Day {
    std::string domain;
    level2::Moment moment = level2::Moment::ref;
    std::string day;  // "20220317"
    // NOLINTNEXTLINE(modernize-use-nullptr): clang-tidy 14 takes a defaulted <=> for a null.
    auto operator<=>(const Day&) const = default;
};
[[nodiscard]] std::filesystem::path relative_path(const Day& day);
[[nodiscard]] Result<std::vector<Day>> all_days(const std::filesystem::path& cache);

struct FoundGrid {
    UtcTime time;
    std::uint64_t bytes_on_disk = 0;
    UtcTime written;  // the file's modification time
    bool pinned = false;
};
// Returns the facts of the grid at a path, or none if there is no regular file.
[[nodiscard]] std::optional<FoundGrid> look_at_grid(const std::filesystem::path& path,
                                                    UtcTime time);

struct FoundTemporary {
    std::string name;
    std::uint64_t bytes_on_disk = 0;
};
struct DayContents {
    std::vector<FoundGrid> grids;  // by time; only grids from `from` to `to`
    std::vector<FoundTemporary> temporaries;
};
[[nodiscard]] Result<DayContents> read_day(const std::filesystem::path& cache, const Day& day,
                                           UtcTime from = UtcTime{},
                                           UtcTime to = last_possible_time);

// Removes the temporary files of killed writers from the cache's directory and from the directories
// of days. Call it only if nobody is writing.
[[nodiscard]] Status sweep_temporaries(FileSystem& file_system, const std::filesystem::path& cache);

}  // namespace stormcellar::cache
