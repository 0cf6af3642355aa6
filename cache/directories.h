// cache/directories.h -- reads the directories of a cache. Used only inside the cache room.
//
// Symbolic links are not followed. A file at the place of a grid without a grid's name is not ours
// and is left out, as is a file that vanishes during the reading. A missing directory holds
// nothing.
//
// Threads   Functions without state, which read directories.
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

[[nodiscard]] tl::unexpected<Error> directory_failure(const std::filesystem::path& path,
                                                      const std::error_code& error);

// Returns the domains, sorted.
[[nodiscard]] Result<std::vector<std::string>> domains_in(const std::filesystem::path& cache);
[[nodiscard]] Result<std::vector<level2::Moment>> moments_in(const std::filesystem::path& domain);
[[nodiscard]] Result<std::vector<std::string>> days_in(const std::filesystem::path& moment);

// One day of one moment of one domain.
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
    UtcTime written;  // when the file was last changed
    bool pinned = false;
};
// Returns the grid of a path, or none if there is no regular file.
[[nodiscard]] std::optional<FoundGrid> look_at_grid(const std::filesystem::path& path,
                                                    UtcTime time);

struct FoundTemporary {
    std::string name;
    std::uint64_t bytes_on_disk = 0;
};
struct DayContents {
    std::vector<FoundGrid> grids;  // by time; only those from `from` to `to`
    std::vector<FoundTemporary> temporaries;
};
[[nodiscard]] Result<DayContents> read_day(const std::filesystem::path& cache, const Day& day,
                                           UtcTime from = UtcTime{},
                                           UtcTime to = last_possible_time);

// Removes every file whose name marks it as being written: the leftovers of killed writers. Call it
// only if nobody is writing.
[[nodiscard]] Status sweep_temporaries(FileSystem& file_system, const std::filesystem::path& cache);

}  // namespace stormcellar::cache
