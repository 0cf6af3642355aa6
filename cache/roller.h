// cache/roller.h -- keeps a cache within its budgets while it is written. Used only inside the
// cache room; stormcellar/cache/store.h is the public header.
//
// A Roller has the account of the grids in the cache. open() makes the account from the files. Each
// roll() corrects the account if other programs removed, added or pinned grids. Before a commit
// writes the first byte, the Roller reserves the largest size that the file may take, and evicts
// grids if there is too little room. It syncs the removal of files before it uses their room again.
// Each file is removed in one step, so a crash leaves a grid whole or removes it.
//
// Threads   Any thread. The account is not locked while files are written, or while grids are
//           evicted.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "cache/account.h"
#include "cache/directories.h"
#include "cache/file_io.h"
#include "cache/pins.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/base/mutex.h"
#include "stormcellar/base/result.h"
#include "stormcellar/cache/budget.h"
#include "stormcellar/cache/store.h"

namespace stormcellar::cache {

class Roller;

// Room for one file that is being written. The destructor frees the room. Then it looks at the
// path, and enters what it finds into the account: the new grid, the old grid or no grid.
class Reservation {
  public:
    Reservation(Roller& roller, GridName name, std::uint64_t bytes)
        : roller_(&roller), name_(std::move(name)), bytes_(bytes) {}
    Reservation(Reservation&& other) noexcept
        : roller_(std::exchange(other.roller_, nullptr)),
          name_(std::move(other.name_)),
          bytes_(other.bytes_) {}
    Reservation& operator=(Reservation&&) = delete;
    Reservation(const Reservation&) = delete;
    Reservation& operator=(const Reservation&) = delete;
    ~Reservation();

  private:
    Roller* roller_;
    GridName name_;
    std::uint64_t bytes_;
};

class Roller {
  public:
    // Removes the leftovers of a killed writer and brings the cache within its budgets. Errors:
    // busy if the cache is already open for rolling.
    static Result<std::unique_ptr<Roller>> open(FileSystem& file_system,
                                                std::filesystem::path directory, Budgets budgets,
                                                Surroundings surroundings);

    // Reserves room for a grid. Returns none if the budgets would not keep the grid, so that the
    // caller need not write it. Commits of the same name wait for each other. Errors: over_budget
    // if Account::is_to_stay() is true for the grid, but evicting all grids that may be evicted
    // does not make enough room.
    Result<std::optional<Reservation>> reserve(const GridName& name, std::uint64_t bytes);
    // Evicts the oldest grids that together hold `bytes`. Call it after a full disk refused the
    // grid. Returns false if no budget limits the space of the grid's group, or if nothing was
    // evicted.
    bool make_room(const GridName& name, std::uint64_t bytes);
    // If the grid's group is unknown, returns true and counts the grid as not kept. A grid of an
    // unknown group is left out if the disk is full, because nobody should wait for such a grid.
    bool leaves_out(const GridName& name);
    // Counts a temporary file that could not be removed. Later rolls try to remove it.
    void add_leftover(std::string_view group, const std::filesystem::path& path);

    using OnStep = std::function<void()>;
    RollReport roll(const OnStep& step = {});  // store.h
    void set_budgets(Budgets budgets);
    [[nodiscard]] StoreUsage usage() const;
    // Returns true if the budgets would keep this grid if it had the mean size of all grids. The
    // answer is as of the last reservation, settlement or roll.
    [[nodiscard]] bool would_keep(const GridName& name) const;
    [[nodiscard]] std::uint64_t block_bytes() const { return block_bytes_; }

  private:
    friend class Reservation;
    struct DayState {
        std::int64_t modified_ns = -1;  // of the directory when it was read; -1: read it again
        std::uint64_t foreign_bytes = 0;
    };
    struct Leftover {
        std::filesystem::path path;
        std::string group;
        std::uint64_t bytes = 0;
    };

    Roller(FileSystem& file_system, std::filesystem::path directory, Budgets budgets,
           Surroundings surroundings, Descriptor lock);
    void settle(const GridName& name, std::uint64_t reserved);
    // Removes the files and syncs their directories. Call it while `mutex_` is not locked.
    [[nodiscard]] std::vector<Result<Evicted>> remove_files(const std::vector<GridName>& victims,
                                                            std::vector<std::string>& problems)
        STORMCELLAR_EXCLUDES(mutex_);
    // Evicts the victims. Unlocks `mutex_` while it removes files.
    void evict(const std::vector<GridName>& victims) STORMCELLAR_REQUIRES(mutex_);
    void evict_all(const std::function<std::vector<GridName>()>& choose)
        STORMCELLAR_REQUIRES(mutex_);
    void keep_budget(const std::string& group, const std::optional<Filling>& filling,
                     RollReport& report, const OnStep& step) STORMCELLAR_REQUIRES(mutex_);
    void limit_others(const OnStep& step) STORMCELLAR_REQUIRES(mutex_);
    void note_reached(const std::string& group, std::uint64_t bytes) STORMCELLAR_REQUIRES(mutex_);
    Status reread(bool all, const OnStep& step);
    Status reread_day(const Day& day, bool even_unchanged);
    void adopt(const Day& day, const DayContents& contents) STORMCELLAR_REQUIRES(mutex_);
    void remove_leftovers() STORMCELLAR_REQUIRES(mutex_);
    [[nodiscard]] std::filesystem::path path_of(const GridName& name) const {
        return directory_ / relative_path(name);
    }

    FileSystem& file_system_;
    const std::filesystem::path directory_;
    const Surroundings surroundings_;
    const Descriptor lock_;  // on the directory itself, to exclude a second writer
    std::uint64_t block_bytes_ = 4096;

    Mutex rolling_;  // one roll at a time
    int rolls_ STORMCELLAR_GUARDED_BY(rolling_) = 0;
    mutable Mutex mutex_;
    ConditionVariable changed_;
    Budgets budgets_ STORMCELLAR_GUARDED_BY(mutex_);
    Account account_ STORMCELLAR_GUARDED_BY(mutex_);
    std::set<GridName> in_flight_ STORMCELLAR_GUARDED_BY(mutex_);  // being written or evicted
    // Groups that reached a limit since the last roll; an empty name means the total limit.
    std::set<std::string> reached_ STORMCELLAR_GUARDED_BY(mutex_);
    std::map<Day, DayState> days_ STORMCELLAR_GUARDED_BY(mutex_);
    std::vector<Leftover> leftovers_ STORMCELLAR_GUARDED_BY(mutex_);
    std::uint64_t evicted_ STORMCELLAR_GUARDED_BY(mutex_) = 0;
    std::uint64_t evicted_bytes_ STORMCELLAR_GUARDED_BY(mutex_) = 0;
    std::uint64_t not_kept_ STORMCELLAR_GUARDED_BY(mutex_) = 0;
    std::uint64_t reported_ STORMCELLAR_GUARDED_BY(mutex_) = 0;
    std::uint64_t reported_bytes_ STORMCELLAR_GUARDED_BY(mutex_) = 0;
    std::vector<std::string> problems_ STORMCELLAR_GUARDED_BY(mutex_);  // since the last roll
};

}  // namespace stormcellar::cache
