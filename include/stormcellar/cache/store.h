// stormcellar/cache/store.h -- the directory of grid files.
//
// stormcellar/cache/grid_name.h defines layout and names. The names are the only index, so nothing
// can disagree with the files. The default domain of a station is its ICAO. A grid that is
// committed again for the same time replaces the old one; a reader keeps the file that it has open.
// Symbolic links inside the store are not followed. Files with other names, or in other places, are
// not ours: they are never listed or changed. Times are from 1970 to 9999.
//
// A store is opened in one of three roles. Each offers everything that the previous one does:
//   StoreReader   lists grids and gives their paths; it never changes anything
//   StoreWriter   commits and removes grids; it keeps no budget
//   RollingStore  the one writer of a cache that keeps its budgets (stormcellar/cache/budget.h), at
//                 each commit and at each roll()
//
// Units     Sizes are in bytes on disk.
// Threads   Many threads may use one store. Many processes may read and evict; one process writes.
//           A StoreReader may be copied, also from a writer; a writer may only be moved.
// Errors    See each function. In addition io and permission, with the reason of the system.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "stormcellar/base/file_system.h"
#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/cache/budget.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/cache/grid_name.h"

namespace stormcellar::cache {

struct StoreEntry {
    std::string domain;
    level2::Moment moment = level2::Moment::ref;
    UtcTime time;
    std::filesystem::path path;
    std::uint64_t bytes_on_disk = 0;
    bool pinned = false;
};

// The space of a file system for the current user. The capacity is the used space plus the space
// that is free for this user.
struct Filling {
    std::uint64_t used_bytes = 0, capacity_bytes = 0;
};
[[nodiscard]] Result<Filling> filling_of(const std::filesystem::path& directory);

// Questions of a rolling store to its surroundings; tests replace the functions.
struct Surroundings {
    std::function<UtcTime()> now = now_utc;
    std::function<Result<Filling>(const std::filesystem::path&)> filling = filling_of;
    // Returns true if a group (a domain without its part) is known, as defined in
    // stormcellar/cache/budget.h. Any thread calls it, often, while the store is locked, so it must
    // not call the store.
    std::function<bool(std::string_view group)> is_known = is_known_group;
};

// The work since the previous roll, commits included.
struct RollReport {
    std::uint64_t evicted = 0, evicted_bytes = 0;
    // One line for each budget that cannot be kept, file that cannot be removed, and directory that
    // cannot be read.
    std::vector<std::string> problems;
};

struct StoreUsage {
    std::uint64_t grids = 0, pinned = 0;
    std::uint64_t bytes = 0;  // on disk; files being written count with their largest possible size
    std::optional<std::uint64_t> budget_bytes;
    std::uint64_t evicted = 0, evicted_bytes = 0, not_kept = 0;  // since the store was opened
    bool operator==(const StoreUsage&) const = default;
};

// Removes the entries in the future (by is_believed()), unless all are. For callers that show the
// newest grid. `entries` are sorted by time.
void leave_out_future(std::vector<StoreEntry>& entries, UtcTime now);

class Roller;

// The events that a committed grid survives.
enum class Durability {
    power_cut,
    // A crash of the process, but not of the system. Readers see the grid whole or not at all, but
    // after a power cut the file may be damaged, or be the previous one. For grids that are
    // replaced within seconds and can be made again.
    until_a_crash,
};

class StoreReader {
  public:
    // Opens a store. Errors: not_found if the directory does not exist.
    static Result<StoreReader> open(std::filesystem::path directory);

    // Returns the path of a grid of this name, whether it exists or not. Errors: bad_argument for a
    // name that no domain can have, and for a time beyond the years 1970 to 9999.
    [[nodiscard]] Result<std::filesystem::path> path_of(const std::string& domain,
                                                        level2::Moment moment, UtcTime time) const;

    // Returns the names, sorted. A directory is a domain if it contains the directory of a moment.
    [[nodiscard]] Result<std::vector<std::string>> domains() const;
    // Returns grids sorted by time. `from` and `to` are inclusive; none: open. The result is empty
    // if nothing matches.
    [[nodiscard]] Result<std::vector<StoreEntry>> list(const std::string& domain,
                                                       level2::Moment moment,
                                                       std::optional<UtcTime> from,
                                                       std::optional<UtcTime> to) const;
    [[nodiscard]] const std::filesystem::path& directory() const { return directory_; }

    [[deprecated("StoreReader::open")]] static Result<StoreReader> open_for_reading(
        std::filesystem::path directory) {
        return open(std::move(directory));
    }

  protected:
    explicit StoreReader(std::filesystem::path directory) : directory_(std::move(directory)) {}

  private:
    std::filesystem::path directory_;
};

// The old name, for programs that read. It will be removed in the next release. Programs that write
// use the name of their role.
using Store [[deprecated("StoreReader, StoreWriter or RollingStore")]] = StoreReader;

class StoreWriter : public StoreReader {
  public:
    // Creates the directory if it is missing. `sweep_temporary` removes the leftovers of a killed
    // writer; only the single writer (the daemon) may set it.
    static Result<StoreWriter> open(FileSystem& file_system, std::filesystem::path directory,
                                    bool sweep_temporary);
    StoreWriter(StoreWriter&&) noexcept;
    StoreWriter& operator=(StoreWriter&&) noexcept;
    StoreWriter(const StoreWriter&) = delete;
    StoreWriter& operator=(const StoreWriter&) = delete;
    ~StoreWriter();

    // Sets how bricks are stored in the files of later commits: unpacked by default. Call it before
    // more than one thread calls commit().
    void pack_with(Packing packing) { packing_ = packing; }

    // Commits a grid and returns its path. The path is empty if the budgets do not keep the grid
    // (it is older than the age, the oldest of a full cache, or of others and beyond their share);
    // then nothing was written. On success the grid and new directories survive a power cut, unless
    // `durability` asks for less. If the disk is full, the oldest grids are evicted, provided a
    // budget of bytes or percent is set. Errors: bad_argument as in path_of() and
    // write_grid_file(); over_budget if there is no room for the newest grid of a known domain or a
    // pinned one, because the budget is smaller than the grid or the held grids are pinned or
    // cannot be removed; no_space if the disk stays full (a grid of others is then not kept,
    // without an error).
    Result<std::filesystem::path> commit(const std::string& domain,
                                         const GridDescription& description,
                                         const grid::BrickView& view,
                                         Durability durability = Durability::power_cut);
    // Returns true if the budgets would keep a grid of this time and of average size, or if there
    // are no budgets. It is for checks before long work; commit() decides.
    [[nodiscard]] bool would_keep(const std::string& domain, level2::Moment moment,
                                  UtcTime time) const;

    // Removes a grid for good, for example a damaged one. A reader keeps the file that it has open.
    // Errors: not_found if it no longer exists.
    Status remove(const StoreEntry& entry);

  protected:
    StoreWriter(FileSystem& file_system, std::filesystem::path directory,
                std::unique_ptr<Roller> roller);
    // Only for a RollingStore, which always has a roller.
    [[nodiscard]] Roller& roller() { return *roller_; }
    [[nodiscard]] const Roller& roller() const { return *roller_; }

  private:
    struct DurableDirectories;
    Status make_directory(const std::filesystem::path& directory);
    Status write(FileSystem& file_system, const std::filesystem::path& path,
                 const GridDescription& description, const grid::BrickView& view,
                 Durability durability);
    Result<std::filesystem::path> commit_within_budgets(const GridName& name,
                                                        const std::filesystem::path& path,
                                                        const GridDescription& description,
                                                        const grid::BrickView& view,
                                                        Durability durability);

    FileSystem* file_system_;
    Packing packing_ = Packing::none;
    std::unique_ptr<DurableDirectories> durable_;  // directories whose names are surely on disk
    std::unique_ptr<Roller> roller_;               // null: keeps no budget
};

// Call roll() every few seconds: only roll() checks how full the file system is, the ages, and what
// other programs changed in the cache.
class RollingStore : public StoreWriter {
  public:
    // Opens a cache: removes the leftovers of a killed writer, counts the grids, and keeps the
    // budgets from then on. Errors: busy if another process has opened the cache as a RollingStore.
    static Result<RollingStore> open(FileSystem& file_system, std::filesystem::path directory,
                                     Budgets budgets, Surroundings surroundings = {});

    // Evicts the grids that exceed the budgets. Calls `step` after each directory that is read and
    // each batch of removed files, so that the caller can see progress.
    RollReport roll(const std::function<void()>& step = {});
    void set_budgets(Budgets budgets);  // applies from the next commit or roll on
    [[nodiscard]] StoreUsage usage() const;

  private:
    RollingStore(FileSystem& file_system, std::filesystem::path directory,
                 std::unique_ptr<Roller> roller);
};

}  // namespace stormcellar::cache
