// stormcellar/cache/store.h -- the directory of grid files.
//
// stormcellar/cache/grid_name.h defines layout and names. There is no index besides the names of
// files. The domain of a station's own grids is its ICAO. A grid that is committed again for the
// same time replaces the old grid; a reader that has the old file open can still read it. Symbolic
// links inside the store are not followed. Files whose names or places do not fit that layout are
// never listed or changed. Times are from 1970 to 9999.
//
// A store is opened in one of three roles. Each role offers everything that the role before it
// offers:
//   StoreReader   lists grids and gives their paths; it never changes anything
//   StoreWriter   commits and removes grids; it ignores budgets
//   RollingStore  the only writer of a cache with budgets (stormcellar/cache/budget.h), which each
//                 commit and each roll() enforces
//
// Units     Sizes are in bytes on disk.
// Threads   Many threads may use one store. Many processes may read and evict; one process writes.
//           A StoreReader may be copied, also from a writer; a writer may only be moved.
// Errors    See each function; also io, permission and others of the file system, with the system's
//           reason.
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

// The space of a file system. The capacity is the used space plus the space that is free for the
// current user.
struct Filling {
    std::uint64_t used_bytes = 0, capacity_bytes = 0;
};
[[nodiscard]] Result<Filling> filling_of(const std::filesystem::path& directory);

// The functions by which a rolling store asks about its surroundings. Tests replace these
// functions.
struct Surroundings {
    std::function<UtcTime()> now = now_utc;
    std::function<Result<Filling>(const std::filesystem::path&)> filling = filling_of;
    // Returns true if a group is known, as defined in stormcellar/cache/budget.h. Any thread may
    // call it, often and while the store is locked, so it must be fast and must not call the store.
    std::function<bool(std::string_view group)> is_known = is_known_group;
};

// Evictions since the previous roll, including those by commits.
struct RollReport {
    std::uint64_t evicted = 0, evicted_bytes = 0;
    // One line for each budget that cannot be kept, and for failures to read the cache or to remove
    // files (only the first few).
    std::vector<std::string> problems;
};

struct StoreUsage {
    std::uint64_t grids = 0, pinned = 0;
    std::uint64_t bytes = 0;  // on disk; files being written count with their largest possible size
    std::optional<std::uint64_t> budget_bytes;
    std::uint64_t evicted = 0, evicted_bytes = 0, not_kept = 0;  // since the store was opened
    bool operator==(const StoreUsage&) const = default;
};

// Removes the entries in the future (by is_believed()), unless all entries are in the future.
// Callers that show the newest grid use this function. `entries` must be sorted by time.
void leave_out_future(std::vector<StoreEntry>& entries, UtcTime now);

class Roller;

// The events that a committed grid survives.
enum class Durability {
    power_cut,
    // The grid survives a crash of the process. After a power cut its file may be damaged, missing
    // or the previous file. Use this for grids that are replaced within seconds and can be made
    // again.
    until_a_crash,
};

class StoreReader {
  public:
    // Opens a store. Errors: not_found if the directory does not exist, not_a_file if it is not a
    // directory.
    static Result<StoreReader> open(std::filesystem::path directory);

    // Returns the path of a grid of this name. The grid need not exist. Errors: bad_argument if
    // is_domain_name() or is_possible() is false.
    [[nodiscard]] Result<std::filesystem::path> path_of(const std::string& domain,
                                                        level2::Moment moment, UtcTime time) const;

    // Returns the names of the domains, sorted. A directory is a domain if it contains the
    // directory of a moment.
    [[nodiscard]] Result<std::vector<std::string>> domains() const;
    // Returns the domain's grids of the moment, sorted by time; an empty list if it has none.
    // `from` and `to` are inclusive. If one of the two is none, there is no limit on that side.
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

// The old name of StoreReader. The next release removes this name. Programs that write use the name
// of their role.
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

    // Sets the form of bricks in the files of later commits. By default, bricks are not packed.
    // Call it before more than one thread calls commit().
    void pack_with(Packing packing) { packing_ = packing; }

    // Commits a grid and returns its path. Without budgets, the grid is always written. With
    // budgets, nothing is written and the path is empty if the grid is too old, would be the oldest
    // of a full cache, or is a grid of others beyond their share. On success the grid and new
    // directories survive a power cut, unless `durability` asks for less. If the disk is full and
    // Budgets::makes_room() is true, the oldest grids are evicted. Errors: bad_argument as in
    // path_of() and write_grid_file(). over_budget if a pinned grid, or the newest grid of a domain
    // and moment in a known group, finds no room: it is larger than a limit, or the other grids are
    // pinned or cannot be removed. no_space if the disk stays full; but for a grid of others,
    // returns an empty path.
    Result<std::filesystem::path> commit(const std::string& domain,
                                         const GridDescription& description,
                                         const grid::BrickView& view,
                                         Durability durability = Durability::power_cut);
    // Returns true if there are no budgets, or if they would keep a grid of this name and of
    // average size. Use it before long work; commit() decides.
    [[nodiscard]] bool would_keep(const std::string& domain, level2::Moment moment,
                                  UtcTime time) const;

    // Removes a grid, for example a damaged one, even if it is pinned. A reader that has the file
    // open can still read it. Errors: not_found if the grid no longer exists.
    Status remove(const StoreEntry& entry);

  protected:
    StoreWriter(FileSystem& file_system, std::filesystem::path directory,
                std::unique_ptr<Roller> roller);
    // Returns the roller. Only a RollingStore may call it, because other writers have no roller.
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
    std::unique_ptr<DurableDirectories> durable_;  // directories whose parents were synced
    std::unique_ptr<Roller> roller_;               // null: no budgets
};

// A writer that respects budgets. Call roll() every few seconds, because only roll() checks the age
// of grids, how full the file system is, and changes by other programs.
class RollingStore : public StoreWriter {
  public:
    // Opens a cache. Creates the directory if it is missing, removes the leftovers of a killed
    // writer, counts the grids, and evicts grids that exceed the budgets. Errors: busy if the cache
    // is already open as a RollingStore.
    static Result<RollingStore> open(FileSystem& file_system, std::filesystem::path directory,
                                     Budgets budgets, Surroundings surroundings = {});

    // Evicts the grids that exceed the budgets. Calls `step` after each directory that is read and
    // before each batch of removals, so that the caller can see progress.
    RollReport roll(const std::function<void()>& step = {});
    void set_budgets(Budgets budgets);  // applies from the next commit or roll on
    [[nodiscard]] StoreUsage usage() const;

  private:
    RollingStore(FileSystem& file_system, std::filesystem::path directory,
                 std::unique_ptr<Roller> roller);
};

}  // namespace stormcellar::cache
