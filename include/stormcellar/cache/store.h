// stormcellar/cache/store.h -- the directory of grid files.
//
// Layout and names: stormcellar/cache/grid_name.h. There is no index: the names are the index, so
// nothing can disagree with the files. The default domain of a station is its ICAO. A grid
// committed again for the same time replaces the old one; a reader keeps the file that it has open.
// Symbolic links inside the store are not followed, and whatever has not such a name at such a
// place is not ours: never listed or touched. Times are from 1970 to 9999.
// A store is opened in one of three roles, and each offers what the role before it does:
//   StoreReader   lists grids and says where they stand; it never changes anything
//   StoreWriter   commits and removes grids; it keeps no budget
//   RollingStore  the one writer of a cache that keeps its budgets (stormcellar/cache/budget.h), at
//                 each commit and at each roll()
// Thread contract: one store may be used by many threads; many processes may read and evict, one
// writes. A StoreReader may be copied, also from a writer; a writer may only be moved.
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

// How full a file system is, for the user that we are: capacity is what is used and what is free
// for us.
struct Filling {
    std::uint64_t used_bytes = 0, capacity_bytes = 0;
};
[[nodiscard]] Result<Filling> filling_of(const std::filesystem::path& directory);

// What a rolling store asks the world; tests answer themselves.
struct Surroundings {
    std::function<UtcTime()> now = now_utc;
    std::function<Result<Filling>(const std::filesystem::path&)> filling = filling_of;
    // Whether a group (a domain without its part) is known, as stormcellar/cache/budget.h means it.
    // Asked by any thread, again and again, while the store is locked: it must not call the store.
    std::function<bool(std::string_view group)> is_known = is_known_group;
};

// Since the roll before, commits included.
struct RollReport {
    std::uint64_t evicted = 0, evicted_bytes = 0;
    // A budget that cannot be kept, a file that cannot be removed, a directory that cannot be read:
    // one line each.
    std::vector<std::string> problems;
};

struct StoreUsage {
    std::uint64_t grids = 0, pinned = 0;
    std::uint64_t bytes = 0;  // on disk; of files being written what they may take at most
    std::optional<std::uint64_t> budget_bytes;
    std::uint64_t evicted = 0, evicted_bytes = 0, not_kept = 0;  // since the store was opened
    bool operator==(const StoreUsage&) const = default;
};

// Leaves out what lies in the future (is_believed()), unless all does: for who shows the newest.
// `entries` are sorted by time.
void leave_out_future(std::vector<StoreEntry>& entries, UtcTime now);

class Roller;

// What a grid that has been committed survives.
enum class Durability {
    power_cut,
    // Of the system: readers see it whole or not at all, but after a power cut the file may be
    // damaged, or the one before it stand. For what is replaced in seconds and can be made again.
    until_a_crash,
};

class StoreReader {
  public:
    // not_found when the directory does not exist.
    static Result<StoreReader> open(std::filesystem::path directory);

    // Where a grid of this name stands or would stand. bad_argument for what is no domain's name,
    // and for a time beyond the years 1970 to 9999.
    [[nodiscard]] Result<std::filesystem::path> path_of(const std::string& domain,
                                                        level2::Moment moment, UtcTime time) const;

    // Sorted. A directory is a domain when it holds a moment's directory.
    [[nodiscard]] Result<std::vector<std::string>> domains() const;
    // Sorted by time; from and to are inclusive, none: open. Empty when nothing matches.
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

// The old name, for programs that read; it goes with the next release. Programs that write name
// their role.
using Store [[deprecated("StoreReader, StoreWriter or RollingStore")]] = StoreReader;

class StoreWriter : public StoreReader {
  public:
    // Creates the directory when it is missing. sweep_temporary: remove leftovers of a killed
    // writer; only the one writer (the daemon) may ask for it.
    static Result<StoreWriter> open(FileSystem& file_system, std::filesystem::path directory,
                                    bool sweep_temporary);
    StoreWriter(StoreWriter&&) noexcept;
    StoreWriter& operator=(StoreWriter&&) noexcept;
    StoreWriter(const StoreWriter&) = delete;
    StoreWriter& operator=(const StoreWriter&) = delete;
    ~StoreWriter();

    // How bricks of the grids that are committed from now on stand in their files; before commit()
    // is called by more than one thread. As they are, unless asked for.
    void pack_with(Packing packing) { packing_ = packing; }

    // The path at which the grid now stands; empty when the budgets do not keep it (it is older
    // than the age, the oldest of a full cache, or of others and beyond what they may hold): then
    // nothing was written. bad_argument as path_of() and write_grid_file(). over_budget for the
    // newest grid of a known domain, or one that is pinned, when there is no room for it: the
    // budget is smaller than the grid, or what is held is pinned or cannot be removed. On success
    // the grid survives a power cut (unless less is asked for), new directories included. On a full
    // disk the oldest grids go, where a budget of bytes or percent is set; when that does not help,
    // no_space, and others' grids are not kept.
    Result<std::filesystem::path> commit(const std::string& domain,
                                         const GridDescription& description,
                                         const grid::BrickView& view,
                                         Durability durability = Durability::power_cut);
    // Whether the budgets would keep a grid of this time, if it is as large as others are on
    // average; true where no budget is kept. For asking before long work; commit() decides.
    [[nodiscard]] bool would_keep(const std::string& domain, level2::Moment moment,
                                  UtcTime time) const;

    // Takes a grid away for good, as one that is damaged; not_found when it is not there any more.
    // A reader keeps the file that it has open.
    Status remove(const StoreEntry& entry);

  protected:
    StoreWriter(FileSystem& file_system, std::filesystem::path directory,
                std::unique_ptr<Roller> roller);
    // Of a RollingStore, which always has one.
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
    std::unique_ptr<DurableDirectories> durable_;  // those whose own names are known to be on disk
    std::unique_ptr<Roller> roller_;               // null: keeps no budget
};

// roll() must be called every few seconds: the file system's filling, ages, and what other programs
// changed in the cache are looked at only there.
class RollingStore : public StoreWriter {
  public:
    // Removes what a killed writer left, counts what is there, and keeps the budgets from here on.
    // busy when another process has opened the cache so.
    static Result<RollingStore> open(FileSystem& file_system, std::filesystem::path directory,
                                     Budgets budgets, Surroundings surroundings = {});

    // `step` is called after each directory that is read and each batch of files that go, for
    // whoever watches that it moves on.
    RollReport roll(const std::function<void()>& step = {});
    void set_budgets(Budgets budgets);  // kept from the next commit or roll on
    [[nodiscard]] StoreUsage usage() const;

  private:
    RollingStore(FileSystem& file_system, std::filesystem::path directory,
                 std::unique_ptr<Roller> roller);
};

}  // namespace stormcellar::cache
